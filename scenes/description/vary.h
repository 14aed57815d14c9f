#pragma once

#include <cstdint>

#include "scenes/description/scene.h"

namespace patina::scenes {

/// The scene with other materials, lights and camera paths of the same kind; the same seed gives the same scene.
///   materials  each object gets another one of material_table, perturbed; textured ones keep their picture, tinted
///   lights     up to 20 % of their distance to the scene away, of another colour temperature and intensity; their
///              summed luminance stays, so that the exposure suits
///   paths      another phase, direction and tempo, distances and angles within 20 %, never faster
/// Lamps and cameras keep at least half their distance to everything and never pass through a surface. The environment
/// is turned. Objects, ids, names and the recording stay.
SyntheticScene varied(SyntheticScene scene, uint64_t seed);

/// How far a lamp moves at most, of its distance to the middle of the objects.
inline constexpr double kVariedLamps = 0.2;

/// The scene with lamps that moved, by up to `reach` of that distance, of other colours and shares of the same total
/// light, and with a turned environment; likewise.
SyntheticScene with_varied_light(SyntheticScene scene, uint64_t seed, double reach = kVariedLamps);

}  // namespace patina::scenes
