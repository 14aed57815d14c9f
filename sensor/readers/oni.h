#pragma once

#include <filesystem>
#include <memory>

#include "patina/source.h"

namespace patina::sensor {

/// Opens a recording of OpenNI, version 1 or 2 (.oni), without OpenNI. Each depth picture is a frame; its colour
/// picture is the one that is nearest in time, within kOniMostApart_s.
///
/// Depth is in millimetres, or in tenths of them where the file says so. Times are the device's, in microseconds. The
/// intrinsics follow from the fields of view; the principal point is the middle. Where both pictures have one size,
/// depth counts as registered to colour, as the file does not say it: both have the colour camera's field of view.
/// Without one, the focal length is that of OpenNI, 525 px at a width of 640. Mirrored pictures are mirrored back.
///
/// Throws Error, naming the file, where it lacks depth or colour, is damaged, or has pictures of a kind that is not
/// known.
std::unique_ptr<Source> open_oni(const std::filesystem::path& file);

inline constexpr double kOniMostApart_s = 0.02;

}  // namespace patina::sensor
