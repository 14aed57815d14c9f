#include "export/stored_zip.h"

#include <array>

#include "engine/core/error.h"

namespace patina {

namespace {

constexpr uint32_t kLocal = 0x0403'4b50, kCentral = 0x0201'4b50, kEnd = 0x0605'4b50;
constexpr uint32_t kZipVersion = 20, kFirstDay = 0x0021;  // 1980-01-01: no time, so that bytes do not depend on it
constexpr uint64_t kLocalBytes = 30;                      // a header before the entry's name

std::array<uint32_t, 256> crc_table() {
    std::array<uint32_t, 256> table{};
    for (uint32_t i = 0; i < table.size(); ++i) {
        uint32_t value = i;
        for (int bit = 0; bit < 8; ++bit) value = value & 1 ? 0xedb8'8320u ^ value >> 1 : value >> 1;
        table[i] = value;
    }
    return table;
}

/// CRC-32 of ZIP (APPNOTE.TXT, 4.4.7).
uint32_t crc_of(std::string_view bytes) {
    static const std::array<uint32_t, 256> kTable = crc_table();
    uint32_t crc = UINT32_MAX;
    for (const char byte : bytes) crc = kTable[(crc ^ static_cast<uint8_t>(byte)) & 0xff] ^ crc >> 8;
    return ~crc;
}

/// A header's fields, little-endian.
class Fields {
  public:
    Fields& word(uint32_t value) { return half(value & 0xffff).half(value >> 16); }
    Fields& half(uint32_t value) {
        bytes_ += static_cast<char>(value & 0xff);
        bytes_ += static_cast<char>(value >> 8 & 0xff);
        return *this;
    }
    const std::string& bytes() const { return bytes_; }

  private:
    std::string bytes_;
};

uint32_t length_of(const std::string& text) { return static_cast<uint32_t>(text.size()); }

}  // namespace

void StoredZip::expect_room(uint64_t bytes) const {
    if (file_.position() + bytes > UINT32_MAX)
        throw Error(path_, ": a ZIP file holds at most ", UINT32_MAX, " bytes, but the scene needs ",
                    file_.position() + bytes, " or more");
}

void StoredZip::add(const std::string& name, std::string_view bytes) {
    expect_room(bytes.size() + 1024);
    Entry entry{name, crc_of(bytes), static_cast<uint32_t>(bytes.size()), static_cast<uint32_t>(file_.position())};
    // An extra field fills up to the alignment; it has four bytes of its own.
    const uint64_t unpadded = file_.position() + kLocalBytes + name.size() + 4;
    const auto padding = static_cast<uint32_t>((kAlignment - unpadded % kAlignment) % kAlignment);
    Fields fields;
    fields.word(kLocal).half(kZipVersion).half(0).half(0).half(0).half(kFirstDay);
    fields.word(entry.crc).word(entry.size).word(entry.size).half(length_of(name)).half(padding + 4);
    file_.write(fields.bytes());
    file_.write(name);
    file_.write(Fields().half(0x1986).half(padding).bytes());  // the tag that USD's own packages use
    file_.write(std::string(padding, '\0'));
    file_.write(bytes);
    entries_.push_back(std::move(entry));
}

void StoredZip::finish() {
    const auto first = static_cast<uint32_t>(file_.position());
    for (const Entry& entry : entries_) {
        expect_room(1024);
        Fields fields;
        fields.word(kCentral).half(kZipVersion).half(kZipVersion).half(0).half(0).half(0).half(kFirstDay);
        fields.word(entry.crc).word(entry.size).word(entry.size).half(length_of(entry.name));
        fields.half(0).half(0).half(0).half(0).word(0).word(entry.first);
        file_.write(fields.bytes());
        file_.write(entry.name);
    }
    const auto count = static_cast<uint32_t>(entries_.size());
    const auto size = static_cast<uint32_t>(file_.position() - first);
    file_.write(Fields().word(kEnd).half(0).half(0).half(count).half(count).word(size).word(first).half(0).bytes());
    file_.close();
}

}  // namespace patina
