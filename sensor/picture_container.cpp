#include "sensor/picture_container.h"

#include <algorithm>
#include <array>
#include <string_view>

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
        if (type == "IHDR" && length >= 8) {
            ByteReader header(chunk.subspan(4), file);
            extent.width = header.number(4);
            extent.height = header.number(4);
        }
        ended = type == "IEND";
    }
    return extent;
}

Extent2D check_jpeg(std::span<const uint8_t> bytes, const std::string& file) {
    ByteReader reader(bytes, file);
    reader.take(2);
    Extent2D extent;
    bool in_scan = false;
    while (true) {
        const uint32_t marker = next_marker(reader, in_scan);
        if (marker == 0xd9) return extent;
        if (stands_alone(marker)) continue;
        const uint32_t length = reader.number(2);
        if (length < 2) throw Error(file, " is damaged: a segment's length is ", length, ", must be at least 2");
        const std::span<const uint8_t> segment = reader.take(length - 2);
        if (is_frame_header(marker) && segment.size() >= 5) {
            ByteReader header(segment.subspan(1), file);
            extent.height = header.number(2);
            extent.width = header.number(2);
        }
        in_scan = marker == 0xda;
    }
}

}  // namespace patina::sensor
