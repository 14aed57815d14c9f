#pragma once

#include <span>
#include <string>

#include "patina/scene.h"

namespace patina {

/// The text of a run's materials.json: every segment that was observed, in ascending order, with its id, its name where
/// `names` (by label) has one, kd (mean over its voxels) where it is known, ks and alpha where they were
/// observed (else "gloss" is "not observed", and "guess" has them where there is one), voxels, observations,
/// confidence, and its intervals where it has any (SegmentReflectance): "interval" of 90 %, "interval_50",
/// "interval_80" and "interval_95". Albedos and alphas have four decimals.
std::string materials_json(std::span<const SegmentReflectance> segments, std::span<const std::string> names);

}  // namespace patina
