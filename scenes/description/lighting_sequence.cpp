#include "scenes/description/lighting_sequence.h"

#include <algorithm>

namespace patina::scenes {
namespace {

constexpr double kBrightest = 0.8;                    // linear value; leaves room for noise below clipping
constexpr uint64_t kOtherNoise = 0x6c69676874696e67;  // "lighting"

}  // namespace

std::optional<LightingSequence> lighting_sequence(const SyntheticScene& scene) {
    double brightest = 0;
    for (const Light& light : scene.lights) {
        const glm::dvec3 radiance = emitted_radiance(light);
        brightest = std::max({brightest, radiance.r, radiance.g, radiance.b});
    }
    if (!scene.lighting || brightest == 0) return std::nullopt;
    LightingSequence sequence{scene, scene.lighting->frames, std::min(kBrightest / brightest, 1.0)};
    sequence.scene.path = scene.lighting->path;
    sequence.scene.recording.seed ^= kOtherNoise;
    sequence.scene.recording.render.seed ^= kOtherNoise;
    return sequence;
}

}  // namespace patina::scenes
