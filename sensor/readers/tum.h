#pragma once

#include <filesystem>
#include <memory>

#include "patina/source.h"

namespace patina::sensor {

/// Whether the folder holds rgb.txt and depth.txt.
bool is_tum_sequence(const std::filesystem::path& folder);

/// Opens a folder of the TUM RGB-D benchmark: rgb.txt, depth.txt ('timestamp path'), and optionally groundtruth.txt.
/// There is one frame per line of depth.txt (5000 units a metre, registered to colour); colour and pose are the nearest
/// in time within 0.02 s. A frame without colour is skipped; one without a pose, as before the motion capture starts,
/// has none. Intrinsics follow the folder's name: those published for freiburg1 to 3 (fr1 to fr3), else the benchmark's
/// default, 525 525 319.5 239.5. Throws Error when a list is missing, damaged or empty, or the pictures are not 640 x
/// 480.
std::unique_ptr<Source> open_tum(const std::filesystem::path& folder);

}  // namespace patina::sensor
