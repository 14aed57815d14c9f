#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
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
};

/// What a mesh becomes in its file: colours alone, or materials and lights too.
struct GlbScene {
    const Mesh& mesh;
    const MeshReflectance* reflectance = nullptr;  ///< of its vertices; null or empty: the mesh has colours alone
    std::span<const std::string> segment_names{};  ///< by label; where one is missing or empty, "segment LABEL"
    std::span<const Light> lights{};
};

/// What became of a mesh on its way into the file.
struct GlbSummary {
    uint64_t vertices = 0;              ///< written; those between segments once for each
    uint64_t triangles = 0;             ///< written
    uint64_t degenerate_triangles = 0;  ///< left out: a repeated vertex, or no area
    uint64_t clamped_colors = 0;        ///< vertices with a channel of COLOR_0 outside 0..1
    uint64_t unknown_albedo = 0;        ///< vertices whose kd is their fused colour, for want of anything better
};

/// How large a part of a mesh is.
struct GlbPartSize {
    uint64_t vertices = 0;
    uint64_t triangles = 0;
    uint64_t vertex_bytes = 32;  ///< of position, normal and colour
};

/// Bytes of the binary buffer that parts of these sizes need. Throws Error where a GLB, whose lengths are 32-bit,
/// cannot hold them.
uint64_t glb_buffer_bytes(std::span<const GlbPartSize> parts);

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
/// around it. The same scene gives the same bytes. Throws Error for a value that is not finite, an index beyond the
/// vertices, a mesh too large, or a disk that refuses.
GlbSummary write_glb(const std::filesystem::path& path, const GlbScene& scene, const GlbInfo& info);

}  // namespace patina
