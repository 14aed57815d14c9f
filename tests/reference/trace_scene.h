#pragma once

#include <cstdint>

#include <glm/glm.hpp>

#include "engine/core/image.h"
#include "sensor/synthetic/scene.h"

namespace patina::reference {

/// What the camera sees at a pixel; all 0 where it sees no object.
struct TracedPixel {
    glm::dvec3 radiance{0};
    double depth_m = 0;
    uint32_t object_id = 0;
    glm::dvec3 normal{0};  ///< world, unit length, towards the camera
};

/// Traces a scene in double precision: rectangles and the six faces of boxes as bounded planes in the world, spheres by
/// the quadratic formula, shading by the paper's Eq. 6; the lights occluded by objects if `shadows`.
Image<TracedPixel> trace_scene(const sensor::Scene& scene, const Intrinsics& camera,
                               const RigidTransform& world_from_camera, bool shadows = false);

}  // namespace patina::reference
