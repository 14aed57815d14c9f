#pragma once

#include <filesystem>
#include <memory>

#include "patina/source.h"

namespace patina::sensor {

/// Whether a folder holds what Open3D's recorder writes: color/, depth/ and camera_intrinsic.json or intrinsic.json.
bool is_open3d_sequence(const std::filesystem::path& folder);

/// A recording of Open3D's recorder, or of its reconstruction system: one picture NAME.jpg or NAME.png in color/ for
/// each NAME.png in depth/, by name; one camera for both, its matrix column by column in the JSON file. Depth in
/// millimetres, 0 is invalid; 30 frames/s. It has no poses. Throws Error when the file is damaged or there are no
/// frames.
std::unique_ptr<Source> open_open3d(const std::filesystem::path& folder);

}  // namespace patina::sensor
