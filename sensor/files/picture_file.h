#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "patina/frame.h"

namespace patina::sensor {

/// The size of a PNG, JPEG or OpenEXR picture; the whole PNG or JPEG file is checked. Throws Error when it is missing,
/// truncated or damaged.
Extent2D picture_extent(const std::filesystem::path& file);

/// Decodes a colour picture: 8-bit PNG or JPEG (grey becomes RGB, alpha is dropped, EXIF rotation is ignored), or
/// OpenEXR with channels R G B, linear. Throws Error when it is missing, truncated, damaged, of another kind, or not of
/// size `expected`.
ColorImage read_color(const std::filesystem::path& file, Extent2D expected);

/// Decodes a depth picture: 16-bit PNG with one channel, as raw units in which `invalid` becomes 0; or OpenEXR in
/// metres (channel Z, depth, Y or R), in which what is not positive and finite becomes 0. Errors as read_color.
DepthImage read_depth(const std::filesystem::path& file, Extent2D expected, uint16_t invalid = 0);

/// The same of a picture file's bytes; `name` stands for the file in messages.
ColorImage decode_color(const std::string& name, std::span<const uint8_t> bytes, Extent2D expected);
DepthImage decode_depth(const std::string& name, std::span<const uint8_t> bytes, Extent2D expected);

/// The name of a frame's picture in Patina's own format without its extension: the index in at least six digits.
std::string picture_stem(uint32_t index);

/// Writes PNG with fixed compression settings: the same pixels give the same bytes. Throws Error when writing fails.
void write_png(const std::filesystem::path& file, const Image<SrgbPixel>& image);
void write_png(const std::filesystem::path& file, const Image<uint16_t>& image);

}  // namespace patina::sensor
