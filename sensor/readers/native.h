#pragma once

#include <filesystem>
#include <memory>

#include "patina/source.h"

namespace patina::sensor {

/// Whether the folder holds sequence.json.
bool is_native_sequence(const std::filesystem::path& folder);

/// Opens a folder in Patina's own format (sequence.json, color/, depth/, and optionally trajectory.txt, timestamps.txt
/// and exposures.txt). A pose belongs to the frame whose timestamp is nearest, within half a frame's time and 0.02 s;
/// frames without one have no pose. Throws Error when a file that concerns all frames is missing, damaged or
/// contradicts another.
std::unique_ptr<Source> open_native(const std::filesystem::path& folder);

}  // namespace patina::sensor
