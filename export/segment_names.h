#pragma once

#include <span>
#include <string>
#include <vector>

#include "export/surface_survey.h"
#include "export/upright.h"
#include "patina/scene.h"

namespace patina {

/// Names of segments by what they are, by label; no two are the same. A segment that `known` has a name for keeps it.
///
/// A plane that has a twentieth of the surface, or a square metre, is the "floor" where it is level and at height 0;
/// the "ceiling" where it faces down, a "wall" where it is upright, if next to nothing of the surface is behind it.
/// Several of a kind are numbered from the largest on: "wall 1", "wall 2". All others are objects with their label, the
/// colour of their mean kd and, if their gloss was observed, "metal", "glossy" or "matt": "object 7, red, glossy".
std::vector<std::string> names_of_segments(std::span<const SegmentReflectance> segments,
                                           std::span<const std::string> known, std::span<const Patch> patches,
                                           const Upright& upright);

/// A word for a linear colour: "dark red", "beige", "white".
std::string color_name(glm::vec3 linear);

}  // namespace patina
