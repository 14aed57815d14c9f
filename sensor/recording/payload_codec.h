#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "patina/frame.h"

namespace patina::sensor {

// Encodings of pictures that every reader of a recording knows. "jpeg", "png" and "exr" are files as they are. The
// others lose nothing and keep pace with a camera. Each row's integers become differences to their left neighbour (the
// first pixel's to 0), modulo their range; floats stay. Then all lowest bytes come first, all second ones after them
// and so on, channel by channel, and all of that is one zstd frame.
inline constexpr std::string_view kPngPicture = "png";
inline constexpr std::string_view kJpegPicture = "jpeg";
inline constexpr std::string_view kExrPicture = "exr";
inline constexpr std::string_view kMirroredJpegPicture = "jpeg-mirrored";  ///< colour whose rows run from right to left
inline constexpr std::string_view kRgb8 = "zstd-rgb8";                     ///< sRGB codes
inline constexpr std::string_view kRgbFloat = "zstd-rgb32f";               ///< linear radiance
inline constexpr std::string_view kDepth16 = "zstd-depth16";               ///< units of SequenceInfo::metres_per_unit
inline constexpr std::string_view kDepthFloat = "zstd-depth32f";           ///< metres

/// Whether decode_color() or decode_depth() knows the encoding.
bool is_color_encoding(std::string_view encoding);
bool is_depth_encoding(std::string_view encoding);

/// The encoding that loses nothing of a picture.
std::string_view lossless_encoding(const ColorImage& color);
std::string_view lossless_encoding(const DepthImage& depth);

/// A picture in its lossless encoding; the same pixels give the same bytes.
std::vector<uint8_t> encode(const ColorImage& color);
std::vector<uint8_t> encode(const DepthImage& depth);

/// A picture of size `expected` from a payload, as the world is; `where` names it in messages. Throws Error where the
/// encoding is not known, or the bytes are damaged or of another size.
ColorImage decode_color(std::string_view encoding, std::span<const uint8_t> content, Extent2D expected,
                        const std::string& where);
DepthImage decode_depth(std::string_view encoding, std::span<const uint8_t> content, Extent2D expected,
                        const std::string& where);

}  // namespace patina::sensor
