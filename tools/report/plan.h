#pragma once

#include <span>
#include <string>

#include <glm/glm.hpp>

#include "export/scene_parts.h"

namespace patina {

/// A plan as an inline SVG element: the surface from straight above without what faces down, the camera's way, and the
/// lamps, over a bar of one metre or ten. `path_m`: positions of the camera in glTF's axes, in the order of frames; may
/// be empty. Empty where the scene has no surface.
std::string plan_svg(const SceneParts& scene, std::span<const glm::dvec3> path_m);

/// The CSS of a plan, for report_page().
std::string_view plan_style();

}  // namespace patina
