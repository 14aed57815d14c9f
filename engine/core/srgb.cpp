#include "engine/core/srgb.h"

#include <cmath>

namespace patina {

namespace {

float linear_from_srgb(float v) { return v <= 0.04045f ? v / 12.92f : std::pow((v + 0.055f) / 1.055f, 2.4f); }

}  // namespace

glm::vec3 linear_color(SrgbPixel encoded) {
    const glm::vec3 v = glm::vec3(encoded) / 255.0f;
    return {linear_from_srgb(v.r), linear_from_srgb(v.g), linear_from_srgb(v.b)};
}

double srgb_encoded(double linear) {
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

}  // namespace patina
