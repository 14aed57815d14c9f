#pragma once

#include <algorithm>
#include <cstdint>

namespace patina {

/// How many pixels apart, in x and y, those of a frame are that look for cells of surface to take: `most_px`, but fewer
/// where that would leave out cells of `cell_m` on surface that faces the camera 3 m away (a picture of few pixels).
/// `focal_px`: of the camera.
inline uint32_t sampling_stride(uint32_t most_px, double focal_px, double cell_m) {
    constexpr double kTypicalDepth_m = 3;
    const double fits = cell_m * focal_px / kTypicalDepth_m;
    return static_cast<uint32_t>(std::clamp(fits, 1.0, static_cast<double>(std::max(most_px, 1u))));
}

}  // namespace patina
