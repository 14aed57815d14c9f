#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "export/environment.h"
#include "export/gltf_material.h"
#include "export/upright.h"
#include "patina/scene.h"
#include "patina/texture.h"
#include "sensor/truth.h"

namespace patina {

/// How a scene is put into a GLB.
struct GlbOptions {
    GltfFresnel fresnel = GltfFresnel::kIor;
    bool raw_attributes = false;  ///< _KD, _KS, _WARD_ALPHA and _FILLED by vertex, too
};

/// What a scene.glb says besides its mesh.
struct GlbInfo {
    std::string version;         ///< of Patina; asset.generator becomes "Patina VERSION"
    std::string name = "scene";  ///< of the scene and its root node
    Upright upright{};           ///< the root node's rotation and translation
    /// What was taken from all positions, metres; told in the root node's extras as "world_offset_m" where it is not 0.
    glm::dvec3 world_offset_m{0};
    std::vector<std::string> segment_names{};  ///< by label; where one is missing or empty, "object LABEL"
    std::vector<Light> lights{};
    /// Told in the scene's extras alone: viewers would let them in through walls that were never seen.
    std::vector<Light> suns{};
    std::vector<AreaLight> windows{};             ///< told in the scene's extras alone, beside lamps or an environment
    double candela_per_intensity = 1;             ///< of the lights, see candela_per_intensity()
    std::optional<GlbEnvironment> environment{};  ///< that stands beside the file, told in the scene's extras
};

/// A mesh, and what it reflects.
struct GlbScene {
    const Mesh& mesh;
    const MeshReflectance* reflectance = nullptr;  ///< of its vertices; null or empty: the mesh has colours alone
};

/// What became of a mesh on its way into the file.
struct GlbSummary {
    uint64_t vertices = 0;              ///< written; those between segments or pieces once for each
    uint64_t triangles = 0;             ///< written
    uint64_t degenerate_triangles = 0;  ///< left out: a repeated vertex, or no area
    uint64_t loose_triangles = 0;       ///< left out before, with stray parts (tidy_surface.h)
    uint64_t collapsed_triangles = 0;   ///< gone before, where fewer show the same
    uint64_t closed_holes = 0;          ///< before (close_holes.h)
    uint64_t unseen_vertices = 0;       ///< before, which no colour picture saw (fill_unseen.h)
    uint64_t clamped_colors = 0;        ///< vertices with a channel outside 0..1: of the base colour, or of their own
    uint64_t unknown_albedo = 0;        ///< vertices whose kd is their fused colour, for want of anything better
    uint64_t texture_pages = 0;
    uint64_t detail_pages = 0;    ///< normal maps: as many, or none
    double texel_m = 0;           ///< edge of a texel on the surface; 0 without a texture
    uint64_t seen_texels = 0;     ///< that a picture showed
    uint64_t filled_texels = 0;   ///< that none showed: what the vertices around know
    uint64_t clamped_texels = 0;  ///< with a channel above 1
};

/// Writes a binary glTF 2.0: a root node that turns and moves the world upright, below it the surface and the lights.
/// Every primitive has POSITION (float32), NORMAL (float32, made unit length) and COLOR_0 (linear, normalised u16,
/// alpha 1).
///
/// Without reflectance the surface is one node "surface" with the mesh's colours and a fully rough dielectric.
///
/// With it, each segment has a node, a mesh and a material of its name, surface without a label those of "surface".
/// Extras of the node have the "segment"'s label. COLOR_0 is the base colour that renders as the diffuse albedo, up to
/// 1. The material is gltf_material()'s. Its extras "ward" have Ward's ks and alpha where they were observed; else
/// "gloss" is "not observed", and they stand in "guess", where there is one. A metal has a base colour instead of
/// COLOR_0. Where a vertex's albedo is not known it is the segment's mean, without one the fused colour, up to 1. On
/// request _KD (float32 x 3) is the diffuse albedo; segments with a specular material then have _KS (float32 x 3) and
/// _WARD_ALPHA (float32), too. Where holes were closed, _FILLED (float32) is 1 at what closes them and 0 elsewhere.
///
/// A surface that lies in a texture has TEXCOORD_0 in place of COLOR_0, and its base colour is that of the texture's
/// page, a picture within the file. A segment in several pages has a primitive and a material for each. Extras of a
/// page's picture have the edge of a texel, "texel_m", and the share of its texels that a picture of the recording
/// showed, "seen". Where some are not, "seen_image" is the number of a picture that says which (seen_mask()).
///
/// Pages with detail have a normalTexture each, and its primitives TANGENT.
///
/// Lights are point lights (KHR_lights_punctual) in candela. Extras of the scene, "photometric", have the factor from
/// linear pixel values times square metres. Extras of a light say that it is not calibrated, and the lamp's radius
/// where that is known.
///
/// Without a triangle left the node "surface" has no mesh. A normal without direction becomes that of the triangles
/// of its piece around it. The same scene gives the same bytes.
///
/// The mesh may come in pieces, each with its own vertices. A segment has a primitive of each piece that it reaches
/// into. Memory holds one piece, and what describes the others.
class GlbWriter {
  public:
    /// Throws Error where the disk refuses.
    explicit GlbWriter(const std::filesystem::path& path, const GlbOptions& options = {});
    ~GlbWriter();
    GlbWriter(const GlbWriter&) = delete;
    GlbWriter& operator=(const GlbWriter&) = delete;

    /// Adds a piece with what its vertices reflect. Null or empty: it has colours alone. Segments of one label are the
    /// same in all pieces. Throws Error for a value that is not finite, an index beyond the vertices, more than a GLB
    /// holds (4 GiB), or a disk that refuses.
    /// `filled`: by vertex, 1 where a hole was closed; empty: nowhere.
    void add(const Mesh& mesh, const MeshReflectance* reflectance, std::span<const uint8_t> filled = {});

    /// Adds a surface that lies in a texture, and the texture; once, with all that lies in it. Throws Error as add().
    void add_textured(const TextureLayout& layout, const std::vector<TexturePage>& pages);

    /// Writes the file; nothing may follow. Throws Error as add().
    GlbSummary finish(const GlbInfo& info);

  private:
    struct State;
    std::unique_ptr<State> state_;
};

/// Writes a mesh in one piece. Throws Error as GlbWriter.
GlbSummary write_glb(const std::filesystem::path& path, const GlbScene& scene, const GlbInfo& info,
                     const GlbOptions& options = {});

}  // namespace patina
