#include "tests/reference/input/convert_depth.h"

#include <cmath>

#include "tests/reference/input/lens.h"

namespace patina::reference {

Image<float> convert_depth(const DepthInput& input) {
    const Extent2D extent = input.camera.extent;
    Image<float> depth_m(extent);
    for (uint32_t y = 0; y < extent.height; ++y) {
        for (uint32_t x = 0; x < extent.width; ++x) {
            const auto source = find_source(input.camera, x, y);
            if (!source) continue;
            const auto column = static_cast<size_t>(std::lround(source->x));
            const auto row = static_cast<size_t>(std::lround(source->y));
            const size_t index = row * extent.width + column;
            const double metres = input.pixels.index() == 0 ? std::get<0>(input.pixels)[index] * input.metres_per_unit
                                                            : static_cast<double>(std::get<1>(input.pixels)[index]);
            if (metres > 0 && metres <= input.max_metres) depth_m.at(x, y) = static_cast<float>(metres);
        }
    }
    return depth_m;
}

}  // namespace patina::reference
