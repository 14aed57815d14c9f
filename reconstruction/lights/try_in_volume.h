#pragma once

#include <span>
#include <vector>

#include "reconstruction/lights/ruled_out_places.h"
#include "reconstruction/lights/search_lights.h"
#include "reconstruction/pipeline.h"

namespace patina {

/// Tries lamps in the reconstruction's volume. A highlight is not explained by a lamp that does not reach it.
/// `ruled_out` may be null; a lamp in one of its places gives nothing. Keeps references to all that it is made with.
/// Waits for the device.
class TryLampsInVolume {
  public:
    TryLampsInVolume(Pipeline& pipeline, std::span<const gpu::LightSample> drawn, const LitSurface& surface,
                     const RuledOutPlaces* ruled_out = nullptr);

    std::vector<TrialLamp> operator()(std::span<const glm::vec3> places_m, uint32_t count) const;

  private:
    Pipeline& pipeline_;
    std::span<const gpu::LightSample> drawn_;
    const LitSurface& surface_;
    const RuledOutPlaces* ruled_out_;
};

}  // namespace patina
