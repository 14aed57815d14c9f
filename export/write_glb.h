#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <glm/gtc/quaternion.hpp>

#include "patina/scene.h"
#include "sensor/truth.h"

namespace patina {

/// Half a turn about x: a world with the first camera's axes (x right, y down, z forward) comes to glTF's y up.
inline constexpr glm::dquat kYDownToYUp{0, 1, 0, 0};

/// What a scene.glb says besides its mesh.
struct GlbInfo {
    std::string version;                       ///< of Patina; asset.generator becomes "Patina VERSION"
    std::string name = "scene";                ///< of the scene and its root node
    glm::dquat y_up_from_world = kYDownToYUp;  ///< the root node's rotation
    /// What was taken from all positions, metres; told in the root node's extras as "world_offset_m" where it is not 0.
    glm::dvec3 world_offset_m{0};
    std::vector<std::string> segment_names{};  ///< by label; where one is missing or empty, "segment LABEL"
    std::vector<Light> lights{};
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
    uint64_t clamped_colors = 0;        ///< vertices with a channel of COLOR_0 outside 0..1
    uint64_t unknown_albedo = 0;        ///< vertices whose kd is their fused colour, for want of anything better
};

/// Writes a binary glTF 2.0: a root node with the rotation, below it the surface and the lights. Every primitive has
/// POSITION (float32), NORMAL (float32, made unit length) and COLOR_0 (linear, normalised u16, alpha 1).
///
/// Without reflectance the surface is one node "surface" with the mesh's colours and a fully rough dielectric.
///
/// With it, each segment has a node, a mesh and a material of its name, surface without a label those of "surface".
/// _KD (float32 x 3) is the diffuse albedo, COLOR_0 the base colour that renders as it; segments with a specular
/// material also have _KS (float32 x 3) and _WARD_ALPHA (float32), the material is gltf_material()'s, and its extras
/// tell Ward's. A metal has a base colour instead of COLOR_0. Where a vertex's albedo is not known it is the segment's
/// mean, without one the fused colour, up to 1.
///
/// Lights are point lights (KHR_lights_punctual) whose intensity is in linear pixel values times square metres instead
/// of candela: the extras say that it is not calibrated, and the lamp's radius where that is known.
///
/// Without a triangle left the node "surface" has no mesh. A normal without direction becomes that of the triangles
/// of its piece around it. The same scene gives the same bytes.
///
/// The mesh may come in pieces, each with its own vertices. A segment has a primitive of each piece that it reaches
/// into. Memory holds one piece, and what describes the others.
class GlbWriter {
  public:
    /// Throws Error where the disk refuses.
    GlbWriter(const std::filesystem::path& path, GlbInfo info);
    ~GlbWriter();
    GlbWriter(const GlbWriter&) = delete;
    GlbWriter& operator=(const GlbWriter&) = delete;

    /// Adds a piece with what its vertices reflect. Null or empty: it has colours alone. Segments of one label are the
    /// same in all pieces. Throws Error for a value that is not finite, an index beyond the vertices, more than a GLB
    /// holds (4 GiB), or a disk that refuses.
    void add(const Mesh& mesh, const MeshReflectance* reflectance);

    /// Writes the file; nothing may follow. Throws Error as add().
    GlbSummary finish();

  private:
    struct State;
    std::unique_ptr<State> state_;
};

/// Writes a mesh in one piece. Throws Error as GlbWriter.
GlbSummary write_glb(const std::filesystem::path& path, const GlbScene& scene, const GlbInfo& info);

}  // namespace patina
