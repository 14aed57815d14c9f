#include "tests/reference/viewer/draw_layer.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace patina::reference {

namespace {

const glm::dvec3 kNoSurface(0.11, 0.11, 0.12), kNoValue(0.22);

double encoded(double linear) {
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

double tone(const LayerStyle& style, double linear) {
    const double x = std::max(0.0, linear * style.exposure), s = style.shoulder;
    if (s >= 1) return encoded(std::min(x, 1.0));
    return encoded(x <= s ? x : s + (1 - s) * (1 - std::exp((s - x) / (1 - s))));
}

glm::dvec3 scale(double at) {
    const std::vector<glm::dvec3> stops{{0.267, 0.005, 0.329},
                                        {0.230, 0.322, 0.546},
                                        {0.128, 0.567, 0.551},
                                        {0.369, 0.789, 0.383},
                                        {0.993, 0.906, 0.144}};
    glm::dvec3 color(0);
    for (size_t i = 0; i < stops.size(); ++i)
        color += std::max(0.0, 1 - std::abs(4 * std::clamp(at, 0.0, 1.0) - static_cast<double>(i))) * stops[i];
    return color;
}

glm::dvec3 with_relief(const LayerStyle& style, const LayerPixel& pixel, glm::dvec3 color) {
    if (pixel.position_m.w <= 0) return kNoSurface;
    if (pixel.normal == glm::dvec3(0)) return color;
    const glm::dvec3 to_point = glm::normalize(glm::dvec3(pixel.position_m) - style.camera_m);
    return color * (1 - style.relief * (1 - std::abs(glm::dot(to_point, pixel.normal))));
}

}  // namespace

glm::dvec3 draw_layer(const LayerStyle& style, const LayerPixel& pixel) {
    const glm::dvec4 v = pixel.value;
    glm::dvec3 color = kNoValue;
    if (style.kind == LayerStyle::kDirection) {
        if (pixel.normal != glm::dvec3(0)) color = (pixel.normal + 1.0) / 2.0;
    } else if (v.a > 0) {
        color = style.kind == LayerStyle::kRadiance ? glm::dvec3(tone(style, v.r), tone(style, v.g), tone(style, v.b))
                                                    : scale((v[style.channel] - style.low) / (style.high - style.low));
    }
    return with_relief(style, pixel, color);
}

glm::dvec3 draw_segment(const LayerStyle& style, const LayerPixel& pixel, unsigned label) {
    if (label == 0) return with_relief(style, pixel, kNoValue);
    const double turn = std::fmod(label * 0.6180339887498949, 1.0), lightness = 0.55 + 0.15 * (label % 3);
    glm::dvec3 color;
    for (int c = 0; c < 3; ++c)
        color[c] = lightness * (0.25 + 0.75 * (0.5 + 0.5 * std::cos(2 * std::numbers::pi * (turn - c / 3.0))));
    return with_relief(style, pixel, color);
}

}  // namespace patina::reference
