#pragma once

#include <cstdint>
#include <string>

#include "export/scene_parts.h"

namespace patina {

/// How large a viewer may be.
struct ViewerOptions {
    uint64_t most_bytes = 8'000'000;
};

/// The text of one HTML file that shows a scene in a browser with WebGL 2, without a network: shaded with the Ward BRDF
/// under its lamps (no shadows), or its kd, ks, alpha and segments. The surface is quantised (quantise.h), pages of the
/// texture become JPEG. Where it would be too large, first triangles go, then the pages' resolution. Throws Error where
/// it is still too large, or a page is damaged. The view begins where most of the surface faces. The same scene gives
/// the same text.
std::string viewer_html(const SceneParts& scene, const ViewerOptions& options = {});

}  // namespace patina
