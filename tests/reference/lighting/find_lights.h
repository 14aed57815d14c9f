#pragma once

#include <vector>

#include <glm/glm.hpp>

#include "patina/camera.h"
#include "patina/image.h"

namespace patina::reference {

/// What find_lights takes for a lamp, as passes/lighting/find_lights.h.
struct LightFinding {
    double threshold = 0.1;
    double bandwidth_m = 0.15;
    double bandwidth_chord = 0.1;
    double radiance_scale = 1;
};

/// A lamp as one frame shows it.
struct Sighting {
    glm::dvec3 center_m{0};
    glm::dvec3 intensity{0};
    glm::dvec3 bearing{0};
    double radius_m = 0;
    double solid_angle_sr = 0;
    bool has_depth = false;
    bool whole = false;  ///< not at the picture's border
};

/// The lamps in one frame, heaviest first: pixels above the threshold, mean-shift from evenly spread seeds, one sphere
/// per mode; in double precision. Colour and depth are one camera's; depth 0: no reading.
std::vector<Sighting> find_lights(const Image<glm::vec3>& color, const Image<float>& depth_m, const Intrinsics& camera,
                                  const RigidTransform& world_from_camera, const LightFinding& settings);

}  // namespace patina::reference
