#pragma once

#include <optional>

#include "scenes/description/scene.h"

namespace patina::scenes {

/// How a scene's lighting sequence is recorded (paper, Section 3.2).
struct LightingSequence {
    SyntheticScene scene;  ///< the scene with the lighting path, and with other noise
    uint32_t frames = 0;
    double exposure = 1;  ///< of the sequence over the main one's
};

/// The lighting sequence: so dark that the brightest channel of the brightest lamp has the linear value 0.8 (never
/// brighter than the main sequence). So no lamp clips and nearly all else is black. Empty where the scene has no
/// lighting path, or no lamp that can be seen (with a radius, and not dark).
std::optional<LightingSequence> lighting_sequence(const SyntheticScene& scene);

}  // namespace patina::scenes
