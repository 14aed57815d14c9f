#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "engine/graph/runner.h"
#include "passes/lighting/find_lights.h"
#include "passes/state/light_tracks.h"
#include "reconstruction/pipeline.h"

namespace patina {

struct LightEstimationSettings {
    FindLightsSettings find;
    uint32_t min_sightings = 5;  ///< a lamp seen in fewer frames is left out
};

/// What speaks for a lamp that was found.
struct LightEvidence {
    float spread_m = 0;      ///< median distance of the sightings from the position
    uint32_t sightings = 0;  ///< frames that showed it whole
    uint32_t clipped = 0;    ///< sightings with clipped pixels, which make its intensity a lower bound
    bool has_depth = true;   ///< false: triangulated from bearings
    bool unseen = false;     ///< no picture shows it: it was found in what it lights
    glm::dvec3 shown{0};     ///< a clipped lamp's intensity in the pictures, where what it lights tells more; else 0
};

/// A lamp and how sure it is. Its values are those of floats.
struct FoundLight {
    Light light;  ///< in the reflectance sequence's pixel values; the radius is that of a sphere that looks like it
    LightEvidence evidence{};
};

/// Orders lamps by the sum of their intensities; equal ones keep their order.
void sort_brightest_first(std::vector<FoundLight>& lights);

/// Finds the lamps of a room from a sequence recorded at low exposure, a graph of its own (paper, Section 3.2). One
/// device, one thread.
class LightEstimation {
  public:
    /// Throws Error for settings that make no sense, or lack of memory.
    LightEstimation(vulkan::Device& device, const LightEstimationSettings& settings);

    /// Takes a frame. `radiance_scale` is the reflectance sequence's exposure divided by this frame's. Throws Error
    /// when a picture is not its camera's size.
    void add(const RgbdFrame& frame, float radiance_scale);

    /// The lamps found so far, brightest first; waits.
    std::vector<FoundLight> found();

    graph::Runner& runner() { return runner_; }

  private:
    LightEstimationSettings settings_;
    graph::Runner runner_;
    LightTracks tracks_;
};

}  // namespace patina
