#pragma once

#include <glm/glm.hpp>

namespace patina::reference {

/// How a layer is drawn; as gpu::DrawLayerParams, in words of its own.
struct LayerStyle {
    enum Kind { kRadiance, kDirection, kValue } kind = kRadiance;
    int channel = 0;
    double low = 0, high = 1;
    double exposure = 1, shoulder = 1;
    glm::dvec3 camera_m{0};
    double relief = 0;
};

/// One pixel of the model.
struct LayerPixel {
    glm::dvec4 position_m{0};
    glm::dvec3 normal{0};
    glm::dvec4 value{0};
};

/// The picture's pixel, encoded for sRGB, 0 to 1.
glm::dvec3 draw_layer(const LayerStyle& style, const LayerPixel& pixel);

/// The same of a segment.
glm::dvec3 draw_segment(const LayerStyle& style, const LayerPixel& pixel, unsigned label);

}  // namespace patina::reference
