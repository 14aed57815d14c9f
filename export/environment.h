#pragma once

#include <optional>
#include <string>

#include <glm/gtc/quaternion.hpp>

#include "patina/image.h"
#include "patina/scene.h"

namespace patina {

/// The name of the picture beside a run's scene.glb.
inline constexpr const char* kEnvironmentFile = "environment.exr";

/// A picture of the light from afar that stands beside a scene.glb.
struct GlbEnvironment {
    std::string file;                       ///< its name
    double luminance_per_pixel_value = 1;   ///< cd/m^2 in the picture over the recording's linear pixel value
    glm::dquat y_up_from_root{1, 0, 0, 0};  ///< the picture's axes from those of the root node
};

/// The light that arrives from afar, as light_map.h lays a picture of all directions out; radiance in linear pixel
/// values: what pictures showed where there is no surface, ambient light where they did not look, and suns, each a disc
/// two pixels wide. Lamps are left out: scene.glb has them. Empty where no light arrives.
Image<glm::vec3> environment_of(const Scene& scene, const glm::dquat& y_up_from_world, Extent2D extent = {1024, 512});

}  // namespace patina
