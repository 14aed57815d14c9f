#include "sensor/recording/payload_codec.h"

#include <algorithm>
#include <cstring>
#include <type_traits>

#include <zstd.h>

#include "engine/core/error.h"
#include "sensor/files/picture_file.h"

namespace patina::sensor {

namespace {

constexpr int kLevel = 1;  // of compression: it is to keep pace with a camera

template <class Pixel>
struct ChannelOf {
    using type = Pixel;
};
template <>
struct ChannelOf<SrgbPixel> {
    using type = uint8_t;
};
template <>
struct ChannelOf<glm::vec3> {
    using type = float;
};

/// Where a channel's values lie in a picture, and where its bytes in the planes.
template <class Pixel>
struct Layout {
    using Channel = typename ChannelOf<Pixel>::type;
    using Word =
        std::conditional_t<sizeof(Channel) == 1, uint8_t, std::conditional_t<sizeof(Channel) == 2, uint16_t, uint32_t>>;
    static constexpr size_t kChannels = sizeof(Pixel) / sizeof(Channel);
    static constexpr bool kDifferences = std::is_integral_v<Channel>;
};

template <class Pixel>
std::vector<uint8_t> planes_of(const Image<Pixel>& image) {
    using L = Layout<Pixel>;
    using Word = typename L::Word;
    const size_t pixels = image.extent().area(), width = image.extent().width;
    std::vector<uint8_t> planes(pixels * sizeof(Pixel));
    const auto* values = reinterpret_cast<const uint8_t*>(image.pixels().data());
    for (size_t channel = 0; channel < L::kChannels; ++channel) {
        uint8_t* plane = planes.data() + channel * sizeof(Word) * pixels;
        Word left = 0;
        for (size_t i = 0; i < pixels; ++i) {
            Word value;
            std::memcpy(&value, values + (i * L::kChannels + channel) * sizeof(Word), sizeof(Word));
            if (i % width == 0) left = 0;
            const auto kept = static_cast<Word>(L::kDifferences ? value - left : value);
            left = value;
            for (size_t byte = 0; byte < sizeof(Word); ++byte)
                plane[byte * pixels + i] = static_cast<uint8_t>(kept >> 8 * byte);
        }
    }
    return planes;
}

template <class Pixel>
Image<Pixel> image_of(const std::vector<uint8_t>& planes, Extent2D extent) {
    using L = Layout<Pixel>;
    using Word = typename L::Word;
    const size_t pixels = extent.area(), width = extent.width;
    Image<Pixel> image(extent);
    auto* values = reinterpret_cast<uint8_t*>(image.pixels().data());
    for (size_t channel = 0; channel < L::kChannels; ++channel) {
        const uint8_t* plane = planes.data() + channel * sizeof(Word) * pixels;
        Word left = 0;
        for (size_t i = 0; i < pixels; ++i) {
            Word value = 0;
            for (size_t byte = 0; byte < sizeof(Word); ++byte)
                value = static_cast<Word>(value | static_cast<Word>(Word{plane[byte * pixels + i]} << 8 * byte));
            if (i % width == 0) left = 0;
            if (L::kDifferences) value = static_cast<Word>(value + left);
            left = value;
            std::memcpy(values + (i * L::kChannels + channel) * sizeof(Word), &value, sizeof(Word));
        }
    }
    return image;
}

std::vector<uint8_t> compressed(const std::vector<uint8_t>& bytes) {
    std::vector<uint8_t> packed(ZSTD_compressBound(bytes.size()));
    const size_t size = ZSTD_compress(packed.data(), packed.size(), bytes.data(), bytes.size(), kLevel);
    PATINA_ASSERT(!ZSTD_isError(size), ZSTD_getErrorName(size));
    packed.resize(size);
    return packed;
}

std::vector<uint8_t> decompressed(std::span<const uint8_t> packed, size_t bytes, const std::string& where) {
    std::vector<uint8_t> content(bytes);
    const size_t size = ZSTD_decompress(content.data(), content.size(), packed.data(), packed.size());
    if (ZSTD_isError(size)) throw Error(where, " cannot be decompressed: ", ZSTD_getErrorName(size));
    if (size != bytes) throw Error(where, " holds ", size, " bytes of pixels, must be ", bytes);
    return content;
}

template <class Pixel>
Image<Pixel> unpacked(std::span<const uint8_t> content, Extent2D expected, const std::string& where) {
    return image_of<Pixel>(decompressed(content, expected.area() * sizeof(Pixel), where), expected);
}

bool is_picture_file(std::string_view encoding) {
    return encoding == kPngPicture || encoding == kJpegPicture || encoding == kExrPicture;
}

Image<SrgbPixel> mirrored_jpeg(std::span<const uint8_t> content, Extent2D expected, const std::string& where) {
    ColorImage decoded = decode_color(where, content, expected);
    auto* picture = std::get_if<Image<SrgbPixel>>(&decoded);
    if (!picture) throw Error(where, " has a colour picture in OpenEXR, not in JPEG");
    const auto width = static_cast<ptrdiff_t>(expected.width);
    auto row = picture->pixels().begin();
    for (uint32_t y = 0; y < expected.height; ++y, row += width) std::reverse(row, row + width);
    return std::move(*picture);
}

[[noreturn]] void fail_unknown(std::string_view encoding, const std::string& where) {
    throw Error(where, " is encoded as '", encoding, "', which is not known");
}

}  // namespace

bool is_color_encoding(std::string_view encoding) {
    return is_picture_file(encoding) || encoding == kMirroredJpegPicture || encoding == kRgb8 || encoding == kRgbFloat;
}

bool is_depth_encoding(std::string_view encoding) {
    return is_picture_file(encoding) || encoding == kDepth16 || encoding == kDepthFloat;
}

std::string_view lossless_encoding(const ColorImage& color) {
    return std::holds_alternative<Image<SrgbPixel>>(color) ? kRgb8 : kRgbFloat;
}

std::string_view lossless_encoding(const DepthImage& depth) {
    return std::holds_alternative<Image<uint16_t>>(depth) ? kDepth16 : kDepthFloat;
}

std::vector<uint8_t> encode(const ColorImage& color) {
    return std::visit([](const auto& image) { return compressed(planes_of(image)); }, color);
}

std::vector<uint8_t> encode(const DepthImage& depth) {
    return std::visit([](const auto& image) { return compressed(planes_of(image)); }, depth);
}

ColorImage decode_color(std::string_view encoding, std::span<const uint8_t> content, Extent2D expected,
                        const std::string& where) {
    if (encoding == kRgb8) return unpacked<SrgbPixel>(content, expected, where);
    if (encoding == kRgbFloat) return unpacked<glm::vec3>(content, expected, where);
    if (encoding == kMirroredJpegPicture) return mirrored_jpeg(content, expected, where);
    if (is_picture_file(encoding)) return decode_color(where, content, expected);
    fail_unknown(encoding, where);
}

DepthImage decode_depth(std::string_view encoding, std::span<const uint8_t> content, Extent2D expected,
                        const std::string& where) {
    if (encoding == kDepth16) return unpacked<uint16_t>(content, expected, where);
    if (encoding == kDepthFloat) return unpacked<float>(content, expected, where);
    if (is_picture_file(encoding)) return decode_depth(where, content, expected);
    fail_unknown(encoding, where);
}

}  // namespace patina::sensor
