#include "sensor/readers/oni_file.h"

#include <algorithm>
#include <cstring>
#include <map>
#include <span>
#include <string_view>
#include <system_error>

#include "engine/core/error.h"
#include "engine/core/input_file.h"

namespace patina::sensor {

namespace {

constexpr std::string_view kMagic = "NI10";
constexpr uint64_t kFileHeaderBytes = 24;
constexpr uint32_t kRecordMagic = 0x0052494e;  // "NIR"
constexpr uint32_t kRecordHeaderBytes = 28;
constexpr uint32_t kMostFieldBytes = 1 << 20;  // lists of modes have some kilobytes

enum RecordType : uint32_t {
    kNodeAddedFirst = 2,
    kIntProperty = 3,
    kGeneralProperty = 6,
    kNewData = 10,
    kEnd = 11,
    kNodeAddedLater = 12,
    kNodeAdded = 13
};
enum NodeType : uint32_t { kDepthNode = 2, kImageNode = 3 };

template <class Value>
Value value_at(std::span<const std::byte> bytes, size_t at) {
    Value value;
    if (bytes.size() < sizeof(Value) || at > bytes.size() - sizeof(Value)) throw Error("a record is too short");
    std::memcpy(&value, bytes.data() + at, sizeof(Value));
    return value;
}

/// A record's fields, one after the other.
class Fields {
  public:
    explicit Fields(std::span<const std::byte> bytes) : bytes_(bytes) {}

    template <class Value>
    Value value() {
        const auto value = value_at<Value>(bytes_, at_);
        at_ += sizeof(Value);
        return value;
    }

    std::span<const std::byte> bytes(size_t count) {
        if (count > bytes_.size() - at_) throw Error("a record is too short");
        at_ += count;
        return bytes_.subspan(at_ - count, count);
    }

    /// With its closing zero in the file, without it here.
    std::string text() {
        const auto characters = bytes(value<uint32_t>());
        const std::string_view whole(reinterpret_cast<const char*>(characters.data()), characters.size());
        return std::string(whole.substr(0, whole.find('\0')));
    }

  private:
    std::span<const std::byte> bytes_;
    size_t at_ = 0;
};

struct Record {
    uint32_t type = 0, node = 0;
    std::vector<std::byte> fields;
    OniStream::Place payload;
};

/// The next record; empty at the end of the file, also where it was cut off within one.
std::optional<Record> next_record(std::ifstream& input, uint64_t& at, uint64_t size) {
    if (size - at < kRecordHeaderBytes) return std::nullopt;
    std::array<uint32_t, 7> header;
    input.seekg(static_cast<std::streamoff>(at));
    if (!input.read(reinterpret_cast<char*>(header.data()), kRecordHeaderBytes)) return std::nullopt;
    const auto [magic, type, node, fields_end, payload_bytes, undo_low, undo_high] = header;
    if (magic != kRecordMagic) throw Error("byte ", at, " begins no record");
    if (fields_end < kRecordHeaderBytes || fields_end > kMostFieldBytes)
        throw Error("the record at byte ", at, " has ", fields_end, " bytes of fields");
    if (size - at < uint64_t{fields_end} + payload_bytes) return std::nullopt;
    Record record{
        type, node, std::vector<std::byte>(fields_end - kRecordHeaderBytes), {at + fields_end, payload_bytes}};
    if (!input.read(reinterpret_cast<char*>(record.fields.data()), std::ssize(record.fields))) return std::nullopt;
    at += uint64_t{fields_end} + payload_bytes;
    return record;
}

void set_int(OniStream& stream, const std::string& name, uint64_t value) {
    if (name == "xnMirror") stream.mirrored = value != 0;
    if (name == "oniPixelFormat") stream.pixel_format = value;
}

void set_general(OniStream& stream, const std::string& name, std::span<const std::byte> value) {
    if (name == "xnMapOutputMode") {
        stream.extent = {value_at<uint32_t>(value, 0), value_at<uint32_t>(value, 4)};
        stream.fps = value_at<uint32_t>(value, 8);
    }
    if (name == "xnFOV") stream.view_rad = {value_at<double>(value, 0), value_at<double>(value, 8)};
}

}  // namespace

OniFile::OniFile(const std::filesystem::path& file) : file_(file) {
    expect_file(file);
    if (!is_oni_file(file)) throw Error(file.string(), " is no recording of OpenNI");
    input_.open(file, std::ios::binary);
    const uint64_t size = std::filesystem::file_size(file);
    uint64_t at = kFileHeaderBytes;
    std::map<uint32_t, OniStream*> by_node;
    try {
        for (auto record = next_record(input_, at, size); record && record->type != kEnd;
             record = next_record(input_, at, size)) {
            Fields fields(record->fields);
            const auto known = by_node.find(record->node);
            OniStream* stream = known == by_node.end() ? nullptr : known->second;
            if (record->type == kNodeAdded || record->type == kNodeAddedLater || record->type == kNodeAddedFirst) {
                fields.text();  // its name
                const auto type = fields.value<uint32_t>();
                if (type != kDepthNode && type != kImageNode) continue;
                std::optional<OniStream>& place = type == kDepthNode ? depth_ : color_;
                if (place) continue;  // a second camera of the same kind
                place.emplace();
                place->codec = fields.value<std::array<char, 4>>();
                by_node[record->node] = &*place;
            } else if (!stream) {
                continue;
            } else if (record->type == kIntProperty) {
                const std::string name = fields.text();
                fields.value<uint32_t>();  // the size of what follows
                set_int(*stream, name, fields.value<uint64_t>());
            } else if (record->type == kGeneralProperty) {
                const std::string name = fields.text();
                set_general(*stream, name, fields.bytes(fields.value<uint32_t>()));
            } else if (record->type == kNewData) {
                stream->timestamps_s.push_back(static_cast<double>(fields.value<uint64_t>()) / 1e6);
                stream->places.push_back(record->payload);
            }
        }
    } catch (const Error& error) {
        throw Error(file.string(), " is damaged: ", error.what());
    }
}

std::vector<uint8_t> OniFile::read(const OniStream::Place& place) const {
    std::vector<uint8_t> bytes(place.bytes);
    input_.clear();
    input_.seekg(static_cast<std::streamoff>(place.begin));
    if (!input_.read(reinterpret_cast<char*>(bytes.data()), std::ssize(bytes)))
        throw Error(file_.string(), ": ", place.bytes, " bytes from byte ", place.begin, " on cannot be read");
    return bytes;
}

bool is_oni_file(const std::filesystem::path& file) {
    std::error_code none;
    if (!std::filesystem::is_regular_file(file, none)) return false;
    std::array<char, kMagic.size()> magic{};
    std::ifstream input(file, std::ios::binary);
    return input.read(magic.data(), magic.size()) && std::string_view(magic.data(), magic.size()) == kMagic;
}

}  // namespace patina::sensor
