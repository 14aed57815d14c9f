#pragma once

#include <cstdint>
#include <span>
#include <variant>

#include <glm/glm.hpp>

#include "engine/core/camera.h"

namespace patina {

/// A depth picture as a sensor gave it. The pixels are read while the frame is declared, not later.
struct DepthInput {
    /// Rows top to bottom: integer units, or metres. 0, negative and non-finite values mean 'no reading'.
    std::variant<std::span<const uint16_t>, std::span<const float>> pixels;
    Intrinsics camera;
    double metres_per_unit = 0.001;  ///< of integer pixels
    double max_metres = 8;           ///< farther readings are dropped
};

/// A colour picture as a camera gave it. The pixels are read while the frame is declared, not later.
struct ColorInput {
    /// Rows top to bottom: 8-bit sRGB, where 255 is clipped, or linear radiance.
    std::variant<std::span<const glm::u8vec3>, std::span<const glm::vec3>> pixels;
    Intrinsics camera;
};

}  // namespace patina
