#pragma once

#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "reconstruction/pipeline.h"
#include "shared/input/camera.h"
#include "shared/lighting/fit_lights.h"

namespace patina {

/// Whether a camera's picture holds a point, far enough from its border for a lamp there to be noticed.
bool is_in_picture(const gpu::Camera& camera, glm::vec3 point_m);

/// Whether whoever carries a camera stands there: near it, or behind it.
bool is_carrier(const gpu::Camera& camera, glm::vec3 point_m);

/// Where a lamp that no picture of low exposure shows cannot be: where such pictures looked, and where whoever carried
/// the camera stood.
class RuledOutPlaces {
  public:
    /// `cameras`: of the pictures, in the reconstruction's world; at most 256 are taken, evenly spread. Keeps a
    /// reference to the pipeline.
    RuledOutPlaces(Pipeline& pipeline, std::span<const gpu::Camera> cameras);

    /// Of each place whether at least two pictures rule it out: they show it, with nothing that the map holds before
    /// it, or were taken from there. Waits for the device.
    std::vector<bool> operator()(std::span<const glm::vec3> places_m) const;

  private:
    Pipeline& pipeline_;
    std::vector<gpu::Camera> cameras_;
    std::vector<gpu::LightSample> views_;  ///< the cameras, as samples that a lamp may reach
};

}  // namespace patina
