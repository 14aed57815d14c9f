#pragma once

#include <filesystem>
#include <string>

#include "export/scene_parts.h"

namespace patina {

/// The text of a scene in USDA: metres, y up. A mesh and a UsdPreviewSurface for each part: roughness, metallic and
/// index of refraction as in scene.glb, base colour from a page or from the vertices (primvars:displayColor). Exact ks
/// and alpha are custom data of the materials, "ward", with "observed". Lamps are UsdLux spheres in candela. `pages`:
/// the names of the texture's pages beside the text.
std::string usda_text(const SceneParts& scene, const std::vector<std::string>& pages);

/// Writes a USDZ package: scene.usda and the texture's pages. Throws Error for more than 4 GiB, or a disk that refuses.
void write_usdz(const std::filesystem::path& path, const SceneParts& scene);

}  // namespace patina
