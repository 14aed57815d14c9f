#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "engine/graph/frame_graph.h"
#include "patina/lighting.h"
#include "shared/lighting/lights.h"

namespace patina {

/// A lamp, as a point.
struct PointLight {
    glm::vec3 position_m{0};  ///< world
    glm::vec3 intensity{0};   ///< RGB, linear pixel value * m^2
    float radius_m = 0;       ///< of the lamp itself, which the map holds as an obstacle; 0: unknown

    bool operator==(const PointLight&) const = default;
};

/// Lamps as they are computed with.
std::vector<PointLight> point_lights(std::span<const Light> lights);

/// The lights of the room: at most gpu::kMaxPointLights point lights and a constant ambient term. What is computed with
/// them keeps the version it was computed with.
class Lights {
  public:
    /// Replaces all. `ambient` is the irradiance over pi (linear pixel value) that every surface receives from all
    /// around. Versions change only if something does. Throws Error for too many lights, or values that are not finite
    /// or below zero.
    void set(std::span<const PointLight> lights, glm::vec3 ambient = glm::vec3(0));

    const std::vector<PointLight>& point_lights() const { return lights_; }
    glm::vec3 ambient() const { return ambient_; }
    uint32_t version() const { return version_; }
    uint32_t position_version() const { return position_version_; }

    /// A uniform buffer of this frame: gpu::LightHeader, gpu::PointLight[gpu::kMaxPointLights].
    graph::BufferId upload(graph::FrameGraph& frame) const;

  private:
    std::vector<PointLight> lights_;
    glm::vec3 ambient_{0};
    uint32_t version_ = 1, position_version_ = 1;
};

}  // namespace patina
