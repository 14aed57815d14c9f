#pragma once

#include <cstdint>

#include <glm/glm.hpp>

#include "patina/image.h"
#include "scenes/description/scene.h"

namespace patina::reference {

/// What the camera sees at a pixel; all 0 where it sees nothing.
struct TracedPixel {
    bool seen = false;
    glm::dvec3 radiance{0};
    double depth_m = 0;
    uint32_t object_id = 0;  ///< 0 on lamps
    glm::dvec3 normal{0};    ///< world, unit length, towards the camera
    glm::dvec3 kd{0};        ///< 0 on lamps
    double facing = 1;       ///< cosine between the surface, not its interpolated normal, and the viewer
};

/// Traces a scene in double precision, comparing every ray with every surface: shading by the paper's Eq. 6; the lights
/// occluded by objects if `shadows`.
Image<TracedPixel> trace_scene(const scenes::SyntheticScene& scene, const Intrinsics& camera,
                               const RigidTransform& world_from_camera, bool shadows = false);

}  // namespace patina::reference
