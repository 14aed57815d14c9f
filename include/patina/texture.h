#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "patina/image.h"
#include "patina/scene.h"

namespace patina {

/// A surface, or a piece of one, whose triangles lie in the pages of a texture. The three vertices of a triangle lie in
/// one page. Where charts meet, each has its own vertices.
struct TexturedSurface {
    Mesh mesh;
    MeshReflectance reflectance;      ///< of the vertices; without kd: the mesh has colours alone
    std::vector<glm::vec2> place_px;  ///< by vertex: in its page; the top left texel's centre is (0.5, 0.5)
    std::vector<uint32_t> pages;      ///< by vertex
    /// By vertex, as glTF has them: xyz is the direction in which a place moves to the right, across the normal; w is 1
    /// or -1: cross(normal, tangent) * w is that in which it moves up. Empty: there are none.
    std::vector<glm::vec4> tangents{};
    std::vector<uint8_t> filled{};  ///< by vertex: 1 where a hole was closed and nothing was measured; empty: nowhere
};

/// Texels around a chart that show what is at its border, so that filters find nothing else there.
inline constexpr uint32_t kTextureGutter = 3;

/// A part of a page that belongs to one segment.
struct TextureBox {
    uint32_t page = 0;
    glm::uvec2 low{0}, high{0};  ///< texels; `high` is outside
    uint32_t label = 0;          ///< 0: none
};

/// Where a surface lies in a texture.
struct TextureLayout {
    double texel_m = 0;  ///< edge of a texel on the surface
    std::vector<Extent2D> pages;
    std::vector<TexturedSurface> pieces;
    std::vector<TextureBox> boxes;  ///< that do not overlap, and hold all of the surface
};

/// What is known of a texel.
enum class TexelState : uint8_t {
    kEmpty,   ///< no surface lies there
    kFilled,  ///< no picture shows it: the value is what the vertices around know
    kSeen
};

/// A page of a texture. `kd` and `states` have its extent.
struct TexturePage {
    Image<glm::vec3> kd;  ///< diffuse albedo, or linear colour where a surface has colours alone; 0 to 1
    Image<TexelState> states;
    /// What the volume's surface faces, by texel, in the frame of the mesh's tangent and normal there; unit length,
    /// (0, 0, 0) where no surface lies. Of the same proportions with as many texels or fewer. Empty: the mesh shows it.
    Image<glm::vec3> detail{};
};

}  // namespace patina
