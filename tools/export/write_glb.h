#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include <glm/gtc/quaternion.hpp>

#include "passes/surface/mesh.h"

namespace patina {

/// Half a turn about x: a world with the first camera's axes (x right, y down, z forward) comes to glTF's y up.
inline constexpr glm::dquat kYDownToYUp{0, 1, 0, 0};

/// What a scene.glb says besides its mesh.
struct GlbInfo {
    std::string version;                       ///< of Patina; asset.generator becomes "Patina VERSION"
    std::string name = "scene";                ///< of the scene and its root node
    glm::dquat y_up_from_world = kYDownToYUp;  ///< the root node's rotation
};

/// What became of a mesh on its way into the file.
struct GlbSummary {
    uint64_t vertices = 0;
    uint64_t triangles = 0;             ///< written
    uint64_t degenerate_triangles = 0;  ///< left out: a repeated vertex, or no area
    uint64_t clamped_colors = 0;        ///< vertices with a colour channel outside 0..1
};

/// Bytes of the binary buffer that a mesh of this size needs. Throws Error where a GLB, whose lengths are 32-bit,
/// cannot hold it.
uint64_t glb_buffer_bytes(uint64_t vertices, uint64_t triangles);

/// Writes a binary glTF 2.0: a root node with the rotation, below it the node "surface" with one primitive of POSITION
/// (float32), NORMAL (float32, made unit length), COLOR_0 (linear, normalised u16, alpha 1) and a fully rough
/// dielectric material. Without a triangle left the node "surface" has no mesh. A normal without direction becomes that
/// of the triangles around it. The same mesh gives the same bytes. Throws Error for a coordinate that is not finite, an
/// index beyond the vertices, a mesh too large, or a disk that refuses.
GlbSummary write_glb(const std::filesystem::path& path, const Mesh& mesh, const GlbInfo& info);

}  // namespace patina
