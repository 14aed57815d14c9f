#include "sensor/files/picture_container.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstring>
#include <string_view>

#include "engine/core/input_file.h"

namespace patina::sensor {
namespace {

constexpr std::array<uint8_t, 8> kPngSignature{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
constexpr std::array<uint8_t, 3> kJpegSignature{0xff, 0xd8, 0xff};
constexpr std::array<uint8_t, 4> kExrSignature{0x76, 0x2f, 0x31, 0x01};

template <size_t N>
bool starts_with(std::span<const uint8_t> bytes, const std::array<uint8_t, N>& signature) {
    return bytes.size() >= N && std::equal(signature.begin(), signature.end(), bytes.begin());
}

/// Reads big-endian numbers one after the other and notices the end of the file.
class ByteReader {
  public:
    ByteReader(std::span<const uint8_t> bytes, const std::string& file) : bytes_(bytes), file_(file) {}

    std::span<const uint8_t> take(size_t count) {
        if (count > bytes_.size() - position_) {
            throw Error(file_, " is truncated: it has ", bytes_.size(), " bytes, but byte ", position_ + count,
                        " is needed");
        }
        position_ += count;
        return bytes_.subspan(position_ - count, count);
    }

    uint32_t number(size_t byte_count) {
        uint32_t value = 0;
        for (const uint8_t byte : take(byte_count)) value = value << 8 | byte;
        return value;
    }

  private:
    std::span<const uint8_t> bytes_;
    const std::string& file_;
    size_t position_ = 0;
};

constexpr std::array<uint32_t, 256> crc_table() {
    std::array<uint32_t, 256> table{};
    for (uint32_t i = 0; i < 256; ++i) {
        table[i] = i;
        for (int bit = 0; bit < 8; ++bit) table[i] = table[i] >> 1 ^ (table[i] & 1 ? 0xedb88320u : 0u);
    }
    return table;
}

/// PNG's checksum (ISO 3309): CRC-32, reflected, of the chunk's type and data.
uint32_t crc32(std::span<const uint8_t> bytes) {
    static constexpr std::array<uint32_t, 256> kTable = crc_table();
    uint32_t crc = 0xffffffffu;
    for (const uint8_t byte : bytes) crc = crc >> 8 ^ kTable[(crc ^ byte) & 0xff];
    return ~crc;
}

/// JPEG's frame headers SOF0 to SOF15; C4, C8 and CC in their midst mean something else.
bool is_frame_header(uint32_t marker) {
    return marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
}

/// Markers without a length: restarts, start of image, TEM.
bool stands_alone(uint32_t marker) { return (marker >= 0xd0 && marker <= 0xd8) || marker == 0x01; }

/// Moves past the next marker and returns its second byte; inside a scan, stuffed bytes (FF 00) and restarts are data.
uint32_t next_marker(ByteReader& reader, bool in_scan) {
    while (true) {
        while (reader.number(1) != 0xff) {
        }
        uint32_t marker = 0xff;
        while (marker == 0xff) marker = reader.number(1);
        const bool is_data = marker == 0 || (in_scan && marker >= 0xd0 && marker <= 0xd7);
        if (!is_data) return marker;
    }
}

}  // namespace

std::optional<PictureFormat> picture_format(std::span<const uint8_t> bytes) {
    if (starts_with(bytes, kPngSignature)) return PictureFormat::kPng;
    if (starts_with(bytes, kJpegSignature)) return PictureFormat::kJpeg;
    if (starts_with(bytes, kExrSignature)) return PictureFormat::kExr;
    return std::nullopt;
}

Extent2D check_png(std::span<const uint8_t> bytes, const std::string& file) {
    ByteReader reader(bytes, file);
    reader.take(kPngSignature.size());
    Extent2D extent;
    for (bool ended = false; !ended;) {
        const uint32_t length = reader.number(4);
        const std::span<const uint8_t> chunk = reader.take(size_t{length} + 4);
        const std::string_view type(reinterpret_cast<const char*>(chunk.data()), 4);
        const uint32_t stored = reader.number(4);
        const uint32_t computed = crc32(chunk);
        if (stored != computed) {
            throw Error(file, " is damaged: chunk ", type, " has checksum ", computed, ", but ", stored, " is stored");
        }
        if (type == "IHDR") {
            if (extent != Extent2D{}) throw Error(file, " is damaged: it has two IHDR chunks, must have 1");
            ByteReader header(chunk.subspan(4), file);
            extent.width = header.number(4);
            extent.height = header.number(4);
            check_picture_size(file, extent.width, extent.height);
        }
        ended = type == "IEND";
    }
    if (extent == Extent2D{}) throw Error(file, " is damaged: it has no IHDR chunk, must have 1");
    return extent;
}

Extent2D check_jpeg(std::span<const uint8_t> bytes, const std::string& file) {
    ByteReader reader(bytes, file);
    reader.take(2);
    Extent2D extent;
    bool in_scan = false;
    while (true) {
        const uint32_t marker = next_marker(reader, in_scan);
        if (marker == 0xd9) break;
        if (stands_alone(marker)) continue;
        const uint32_t length = reader.number(2);
        if (length < 2) throw Error(file, " is damaged: a segment's length is ", length, ", must be at least 2");
        const std::span<const uint8_t> segment = reader.take(length - 2);
        if (is_frame_header(marker)) {
            if (extent != Extent2D{}) throw Error(file, " is damaged: it has two frame headers, must have 1");
            ByteReader header(segment.subspan(std::min<size_t>(segment.size(), 1)), file);
            extent.height = header.number(2);
            extent.width = header.number(2);
            check_picture_size(file, extent.width, extent.height);
        }
        in_scan = marker == 0xda;
    }
    if (extent == Extent2D{}) throw Error(file, " is damaged: it has no frame header, must have 1");
    return extent;
}

namespace {

/// Walks an OpenEXR file's headers. Numbers are little-endian.
class ExrHeaders {
  public:
    ExrHeaders(std::span<const uint8_t> bytes, const std::string& file)
        : bytes_(bytes.subspan(0, std::min<size_t>(bytes.size(), limits::kHeaderBytes))),
          size_(bytes.size()),
          file_(file),
          reader_(bytes_, file) {}

    Extent2D check() {
        reader_.take(kExrSignature.size());
        const bool several_parts = (number() & 0x1000) != 0;
        const Extent2D first = part();
        while (several_parts && !ended()) part();
        return first;
    }

  private:
    /// What a part's header says of what decoding it takes.
    struct Part {
        Extent2D extent;
        uint64_t channels = 0;
        Extent2D tile;
    };

    uint32_t number() {
        uint32_t value = 0;
        const std::span<const uint8_t> four = reader_.take(4);
        for (size_t i = 4; i-- > 0;) value = value << 8 | four[i];
        return value;
    }

    std::string name() {
        std::string name;
        while (const uint32_t letter = reader_.number(1)) name += static_cast<char>(letter);
        return name;
    }

    /// An empty header ends the parts.
    bool ended() {
        next_ = name();
        return next_.empty();
    }

    Extent2D part() {
        Part part;
        std::string attribute = next_.empty() ? name() : std::move(next_);
        next_.clear();
        for (; !attribute.empty(); attribute = name()) {
            const std::string type = name();
            const uint32_t length = number();
            const std::span<const uint8_t> value = reader_.take(length);
            if (attribute == "dataWindow" && type == "box2i") part.extent = window(value);
            if (attribute == "channels" && type == "chlist") part.channels = count_channels(value);
            if (attribute == "tiles" && type == "tiledesc") part.tile = tile(value);
        }
        check(part);
        return part.extent;
    }

    Extent2D window(std::span<const uint8_t> value) const {
        if (value.size() != 16) throw Error(file_, " is damaged: its dataWindow has ", value.size(), " bytes, not 16");
        std::array<int32_t, 4> edges;
        std::memcpy(edges.data(), value.data(), sizeof(edges));
        const int64_t width = int64_t{edges[2]} - edges[0] + 1, height = int64_t{edges[3]} - edges[1] + 1;
        check_picture_size(file_, static_cast<uint64_t>(std::max<int64_t>(width, 0)),
                           static_cast<uint64_t>(std::max<int64_t>(height, 0)));
        return {static_cast<uint32_t>(width), static_cast<uint32_t>(height)};
    }

    Extent2D tile(std::span<const uint8_t> value) const {
        if (value.size() != 9) throw Error(file_, " is damaged: its tiles have ", value.size(), " bytes, not 9");
        Extent2D tile;
        std::memcpy(&tile.width, value.data(), 4);
        std::memcpy(&tile.height, value.data() + 4, 4);
        check_picture_size(file_ + "'s tile", tile.width, tile.height);
        return tile;
    }

    /// Each has a name, its terminating zero and 16 bytes.
    uint64_t count_channels(std::span<const uint8_t> list) const {
        ByteReader reader(list, file_);
        uint64_t channels = 0;
        for (; reader.number(1) != 0; ++channels) {
            while (reader.number(1) != 0) {
            }
            reader.take(16);
        }
        return channels;
    }

    /// What OpenEXR allots before it finds that the pixels are not there.
    void check(const Part& part) const {
        if (part.extent == Extent2D{}) throw Error(file_, " is damaged: it has no dataWindow");
        constexpr uint64_t kMostRows = 256, kNumberBytes = 4;  // of a block of DWAB, of a float
        const uint64_t rows = std::max<uint64_t>(part.extent.height, kMostRows);
        const uint64_t pixels = std::max<uint64_t>(part.extent.width * rows, part.tile.area());
        if (part.channels > limits::kPlanesBytes / kNumberBytes / pixels) {
            throw Error(file_, " has ", part.channels, " channels of ", part.extent, " pixels, more than ",
                        limits::kPlanesBytes, " bytes hold");
        }
        if (part.tile == Extent2D{}) return;
        constexpr uint64_t kOffsetBytes = 8;
        const uint64_t across = (part.extent.width + uint64_t{part.tile.width} - 1) / part.tile.width;
        const uint64_t tiles = across * ((part.extent.height + uint64_t{part.tile.height} - 1) / part.tile.height);
        if (tiles > size_ / kOffsetBytes)
            throw Error(file_, " is truncated: it has ", size_, " bytes, but ", tiles, " tiles");
    }

    std::span<const uint8_t> bytes_;
    uint64_t size_;
    const std::string& file_;
    ByteReader reader_;
    std::string next_;  ///< a further part's first attribute, once read
};

}  // namespace

Extent2D check_exr(std::span<const uint8_t> bytes, const std::string& file) { return ExrHeaders(bytes, file).check(); }

Extent2D check_radiance(std::span<const uint8_t> bytes, const std::string& file) {
    std::string_view rest(reinterpret_cast<const char*>(bytes.data()),
                          std::min<size_t>(bytes.size(), limits::kHeaderBytes));
    if (!rest.starts_with("#?")) throw Error(file, " is no Radiance picture: it does not begin with '#?'");
    std::string line = "#?";
    while (!line.empty()) {  // an empty line ends the header
        const size_t end = rest.find('\n');
        if (end == std::string_view::npos)
            throw Error(file, " is truncated: its header ends within ", rest.size(), " bytes");
        line = rest.substr(0, end);
        rest.remove_prefix(end + 1);
    }
    const std::string size(rest.substr(0, rest.find('\n')).substr(0, 40));
    unsigned width = 0, height = 0;
    int read = 0;
    if (std::sscanf(size.c_str(), "-Y %9u +X %9u%n", &height, &width, &read) != 2 ||
        read != static_cast<int>(size.size()))
        throw Error(file, " has a size of '", size, "', must be '-Y ROWS +X COLUMNS'");
    check_picture_size(file, width, height);
    return {width, height};
}

}  // namespace patina::sensor
