#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "export/atlas/lay_out_texture.h"
#include "export/surface_survey.h"
#include "export/tidy_surface.h"
#include "export/write_glb.h"
#include "patina/scene.h"

namespace patina {

/// A scene's lights as its files hold them, to a millionth, where the digits of a float end: 0.3, not 0.30000001192. In
/// the scene's coordinates.
Lighting rounded(Lighting lighting);

/// The same in the recording's world, as lights.json holds them.
Lighting in_recorded_world(const Scene& scene);

/// What a user may say about a scene's files.
struct SceneFileOptions {
    GlbOptions glb{};
    TidyOptions tidy{};                       ///< of scene.glb; tiles have all that was reconstructed
    std::optional<TextureOptions> texture{};  ///< of scene.glb; empty: vertices have colours in its place
    std::optional<glm::dvec3> up{};           ///< direction in the world, of any length but 0; empty: it is found
    std::string environment{};  ///< the name of the picture of light from afar beside scene.glb; empty: there is none
};

/// What its scene.glb and tiles say besides the surface, which the survey is of: where up is, the factor to candela,
/// the segments' names; `version`: of Patina.
GlbInfo glb_info(const Scene& scene, const SurfaceSurvey& survey, const SceneFileOptions& options,
                 const std::string& version);

/// What a surface's pieces are given to, and what gives them all (GlbWriter::add).
using TakePiece = std::function<void(const Mesh&, const MeshReflectance&)>;
using GivePieces = std::function<void(const TakePiece&)>;

/// What bakes the pages of a texture for a surface (Pipeline::bake_texture).
using BakeTexture = std::function<std::vector<TexturePage>(const TextureLayout&)>;

/// A scene.glb that was written.
struct WrittenGlb {
    GlbSummary summary;
    GlbInfo info;
    Image<glm::vec3> environment;  ///< in cd/m^2, to be written as the options name it; empty where no light arrives
};

/// Writes scene.glb, with the surface in pieces in place of the scene's, tidied piece by piece; `version`: of Patina.
/// With a limit of triangles, or a texture, memory holds the tidied surface. `bake`: where options ask for a texture.
/// Throws Error as GlbWriter does, and what the others throw.
WrittenGlb write_scene_glb(const std::filesystem::path& file, const Scene& scene, const GivePieces& pieces,
                           const SceneFileOptions& options, const std::string& version, const BakeTexture& bake = {});

}  // namespace patina
