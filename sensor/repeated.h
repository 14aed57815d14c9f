#pragma once

#include <optional>
#include <string>

#include "patina/frame.h"

namespace patina::sensor {

/// Whether two pictures are of the same kind, extent and pixels.
bool same_pixels(const ColorImage& a, const ColorImage& b);
bool same_pixels(const DepthImage& a, const DepthImage& b);

/// Why a frame says nothing that the frame before did not: its picture and depth are the same, or it was taken at the
/// same time. A few words; empty where it is new.
std::optional<std::string> repeats(const Frame& frame, const Frame& before);

}  // namespace patina::sensor
