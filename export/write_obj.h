#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "export/scene_parts.h"

namespace patina {

/// Takes a file of a name; it may throw.
using PutFile = std::function<void(const std::string& name, std::string_view bytes)>;

/// Writes a scene's surface as Wavefront OBJ, in glTF's axes: STEM.obj, STEM.mtl and the texture's pages, STEM-1.jpg
/// and so on. Each segment is a group. Vertices without a page have their linear base colour behind their position, as
/// many readers know it. Materials have Kd, Ks (reflectance at normal incidence), Ns (the Blinn-Phong exponent that is
/// as wide as the lobe, 2 / alpha^2 - 2) and, as an extension, Pr (roughness), Pm (metallic) and Ni (index of
/// refraction).
void write_obj(const std::string& stem, const SceneParts& scene, const PutFile& put);

}  // namespace patina
