#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "export/write_glb.h"
#include "patina/scene.h"

namespace patina {

/// A scene's lights as its files hold them, to a millionth, where the digits of a float end: 0.3, not 0.30000001192. In
/// the scene's coordinates.
Lighting rounded(Lighting lighting);

/// The same in the recording's world, as lights.json holds them.
Lighting in_recorded_world(const Scene& scene);

/// Writes scene.glb; `version`: of Patina. Throws Error as write_glb() does.
GlbSummary write_scene_glb(const std::filesystem::path& file, const Scene& scene, const std::string& version);

}  // namespace patina
