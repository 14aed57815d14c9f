#include "tests/reference/input/convert_color.h"

#include <algorithm>
#include <cmath>

#include "tests/reference/input/lens.h"

namespace patina::reference {

namespace {

/// One source pixel: linear RGB, and 1 (valid), 0.5 (clipped) or 0 (not finite).
struct Sample {
    glm::dvec3 rgb{0};
    double worth = 1;
};

double linear_from_srgb(double encoded) {
    return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

Sample sample(const ColorInput& input, uint32_t x, uint32_t y) {
    const size_t index = size_t{y} * input.camera.extent.width + x;
    Sample result;
    for (int channel = 0; channel < 3; ++channel) {
        if (input.pixels.index() == 0) {
            const int code = std::get<0>(input.pixels)[index][channel];
            result.rgb[channel] = linear_from_srgb(code / 255.0);
            if (code == 255) result.worth = std::min(result.worth, 0.5);
        } else {
            const double value = std::get<1>(input.pixels)[index][channel];
            if (!std::isfinite(value)) return {{}, 0};
            result.rgb[channel] = std::clamp(value, 0.0, 65504.0);
            if (value > 65504.0) result.worth = 0.5;
        }
    }
    return result;
}

Sample interpolate(const ColorInput& input, glm::dvec2 source) {
    const Extent2D extent = input.camera.extent;
    const double sx = std::clamp(source.x, 0.0, extent.width - 1.0);
    const double sy = std::clamp(source.y, 0.0, extent.height - 1.0);
    const auto x0 = static_cast<uint32_t>(sx), y0 = static_cast<uint32_t>(sy);
    Sample sum;
    for (uint32_t dy = 0; dy < 2; ++dy) {
        for (uint32_t dx = 0; dx < 2; ++dx) {
            const Sample tap = sample(input, std::min(x0 + dx, extent.width - 1), std::min(y0 + dy, extent.height - 1));
            const double weight = (dx ? sx - x0 : 1 - (sx - x0)) * (dy ? sy - y0 : 1 - (sy - y0));
            sum.rgb += weight * tap.rgb;
            sum.worth = std::min(sum.worth, tap.worth);
        }
    }
    return sum;
}

}  // namespace

Image<glm::vec4> convert_color(const ColorInput& input) {
    const Extent2D extent = input.camera.extent;
    Image<glm::vec4> color(extent, glm::vec4(0));
    for (uint32_t y = 0; y < extent.height; ++y) {
        for (uint32_t x = 0; x < extent.width; ++x) {
            const auto source = find_source(input.camera, x, y);
            if (!source) continue;
            const Sample result = input.camera.distorted() ? interpolate(input, *source) : sample(input, x, y);
            if (result.worth > 0) color.at(x, y) = glm::vec4(glm::dvec4(result.rgb, result.worth));
        }
    }
    return color;
}

}  // namespace patina::reference
