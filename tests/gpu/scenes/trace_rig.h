#pragma once

#include <memory>

#include "scenes/render/render.h"
#include "tests/gpu/gpu_test.h"
#include "tests/reference/scenes/trace_scene.h"

namespace patina {

/// Renders synthetic scenes and compares them with the double-precision reference.
class TraceTest : public GpuTest {
  protected:
    struct Traced {
        Image<glm::vec4> radiance;
        Image<float> depth_m;
        Image<uint32_t> object_id;
        Image<glm::vec4> normals;
        Image<glm::vec4> kd;
        Image<glm::vec4> ks_alpha;

        glm::vec3 normal(uint32_t x, uint32_t y) const { return glm::vec3(normals.at(x, y)); }
        bool hit(size_t pixel) const { return radiance.pixels()[pixel].a > 0; }
    };

    Traced trace(const scenes::SyntheticScene& scene, const Intrinsics& camera, const RigidTransform& world_from_camera,
                 const scenes::RenderSettings& settings = {.shadows = false});

    /// How many pixels the two see differently.
    struct Differences {
        size_t surface = 0;  ///< another object, or another side of it
        size_t shadow = 0;   ///< the same surface, but a light reaches it only in one of them
    };

    /// Expects depth, normal, kd, material and radiance to agree wherever both see the same surface (one object,
    /// normals within 1e-3) and, with `shadows`, the same lights; counts where they do not.
    static Differences compare(const Traced& got, const Image<reference::TracedPixel>& expected,
                               const scenes::SyntheticScene& scene, bool shadows = false);

    /// Traces the scene on both sides with and without shadows, and compares; expects at most `edge_share` of the
    /// pixels to lie so near an edge, of a surface or a shadow, that fp32 takes the other side.
    void expect_reference(const scenes::SyntheticScene& scene, const Intrinsics& camera,
                          const RigidTransform& world_from_camera, double edge_share);
};

/// A camera for an extent, with the default scene's field of view.
Intrinsics camera_of(Extent2D extent);

/// A part in the world, turned by `angle_rad` about `axis`.
scenes::Part part_at(scenes::Shape shape, glm::dvec3 position_m, glm::dvec3 axis = {0, 1, 0}, double angle_rad = 0);

/// An object of some glossy material.
scenes::SceneObject glossy(uint32_t id, std::vector<scenes::Part> parts);

/// A picture of smoothly varying, distinct texels.
scenes::Texture smooth_texture(Extent2D extent, glm::dvec2 repeat);

/// A unit sphere of 20 * 4^levels triangles, with its normals and some texture coordinates.
scenes::TriangleMesh icosphere(int levels);

/// The surface of a cube of edge 2 around the origin, each face cut into cells^2 squares of two triangles; closed: the
/// positions of edges and corners are equal, bit by bit.
scenes::TriangleMesh cube_mesh(int cells);

inline scenes::MeshShape shape_of(scenes::TriangleMesh mesh) {
    return {std::make_shared<const scenes::TriangleMesh>(std::move(mesh))};
}

}  // namespace patina
