#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include <glm/glm.hpp>

#include "patina/image.h"

namespace patina::sensor {

/// The channels R G B of an OpenEXR picture, half or float, linear, from the bytes of the file `name`. Throws Error
/// when one is missing, or the file is damaged or larger than is decoded.
Image<glm::vec3> read_exr_color(const std::string& name, std::span<const uint8_t> bytes);

Image<glm::vec3> read_exr_color(const std::filesystem::path& file);

/// The depth of an OpenEXR picture: the first of the channels Z, depth, Y and R. Otherwise as read_exr_color.
Image<float> read_exr_depth(const std::string& name, std::span<const uint8_t> bytes);
Image<float> read_exr_depth(const std::filesystem::path& file);

/// Writes the channels R G B as floats, ZIP compressed; the same pixels give the same bytes. Throws Error when writing
/// fails.
void write_exr_color(const std::filesystem::path& file, const Image<glm::vec3>& image);

}  // namespace patina::sensor
