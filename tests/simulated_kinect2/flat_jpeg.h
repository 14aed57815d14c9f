#pragma once

#include <cstdint>
#include <vector>

namespace patina::sensor::kinect2::testing {

/// A baseline JPEG (4:2:2) in which every pixel has the same grey, 0 to 255, to within 1. 16 KB at 1920 x 1080. `width`
/// is a multiple of 16; sizes up to 65 535.
std::vector<uint8_t> flat_jpeg(uint16_t width, uint16_t height, uint8_t grey);

}  // namespace patina::sensor::kinect2::testing
