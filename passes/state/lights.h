#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "engine/graph/frame_graph.h"
#include "engine/graph/state_visitor.h"
#include "patina/lighting.h"
#include "shared/lighting/lights.h"

namespace patina {

/// The lights of the room: at most gpu::kMaxPointLights lamps and a constant ambient term. What is computed with them
/// keeps the version it was computed with.
class Lights {
  public:
    /// Replaces all. Positions are in the map's world; a lamp's radius is that of the obstacle that the map holds.
    /// `ambient` is the irradiance over pi (linear pixel value) that every surface receives from all around. All are
    /// rounded to float; versions change only if something does. Throws Error for too many lights, values that are not
    /// finite or below zero, or an axis whose length is not 1 or that a sun has.
    void set(std::span<const Light> lights, glm::dvec3 ambient = glm::dvec3(0));

    void visit(graph::StateVisitor& visitor);

    const std::vector<gpu::PointLight>& point_lights() const { return lights_; }
    glm::vec3 ambient() const { return ambient_; }
    uint32_t version() const { return version_; }
    uint32_t position_version() const { return position_version_; }

    /// A uniform buffer of this frame: gpu::LightHeader, gpu::PointLight[gpu::kMaxPointLights].
    graph::BufferId upload(graph::FrameGraph& frame) const;

  private:
    std::vector<gpu::PointLight> lights_;
    glm::vec3 ambient_{0};
    uint32_t version_ = 1, position_version_ = 1;
};

}  // namespace patina
