#pragma once

#include <cstdint>

#include <glm/glm.hpp>

#include "patina/image.h"
#include "scenes/description/scene.h"

namespace patina::reference {

/// Radiance found by random samples, and its standard error.
struct Estimate {
    glm::dvec3 radiance{0};
    glm::dvec3 error{0};
};

/// The light of all lamps, as spheres if they have a radius, and of the environment, with shadows and at most one
/// bounce, at every pixel: by samples uniform over the surfaces of lamps and over the hemispheres of directions, in
/// double precision. Where no surface is seen, 0. Textures are not supported.
Image<Estimate> gather_light(const scenes::SyntheticScene& scene, const Intrinsics& camera,
                             const RigidTransform& world_from_camera, uint32_t samples);

}  // namespace patina::reference
