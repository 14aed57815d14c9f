#pragma once

#include <filesystem>

#include <glm/glm.hpp>

#include "engine/core/image.h"

namespace patina::sensor {

/// The size of an OpenEXR picture's data window. Throws Error when the file is damaged.
Extent2D exr_extent(const std::filesystem::path& file);

/// The channels R G B of an OpenEXR picture, half or float, linear. Throws Error when one is missing or the file is
/// damaged.
Image<glm::vec3> read_exr_color(const std::filesystem::path& file);

/// The depth of an OpenEXR picture: the first of the channels Z, depth, Y and R. Errors as read_exr_color.
Image<float> read_exr_depth(const std::filesystem::path& file);

/// Writes the channels R G B as floats, ZIP compressed; the same pixels give the same bytes. Throws Error when writing
/// fails.
void write_exr_color(const std::filesystem::path& file, const Image<glm::vec3>& image);

}  // namespace patina::sensor
