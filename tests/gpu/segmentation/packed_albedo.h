#pragma once

#include <cstdint>

#include <glm/glm.hpp>

namespace patina {

/// kd up to 1 as the refinement packs it: a shared exponent of 5 bits, which puts a half at 256; and its certainty,
/// three times 10 bits.
inline glm::uvec2 packed_albedo(glm::vec3 kd, float certainty) {
    const glm::uvec3 m(glm::round(kd * 512.0f));
    const auto c = static_cast<uint32_t>(certainty * 1023);
    return {m.r | m.g << 9 | m.b << 18 | 15u << 27, c | c << 10 | c << 20};
}

}  // namespace patina
