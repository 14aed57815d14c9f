#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "reconstruction/lights/light_estimation.h"
#include "reconstruction/lights/search_lights.h"
#include "reconstruction/pipeline.h"

namespace patina {

/// Light that reaches drawn samples, by place.
struct MeasuredLight {
    std::vector<glm::vec3> known;  ///< irradiance over pi, from measured lamps and from what rays met
    std::vector<float> unknown;    ///< the same of light of 1 from the directions of which nothing is known
    glm::vec3 usual{0};            ///< radiance of known directions, on average
    glm::vec3 tint{1};             ///< of the lamps; its mean is 1
    float white_albedo = 0.8f;     ///< of the brightest tenth of the surface, so far as light does not tell it
    bool low_exposure = true;      ///< else pictures clip what is bright, so that known light is too dark
};

struct UnmeasuredLamps {
    std::vector<Light> clipped;       ///< the clipped lamps, which may be flat; empty where they are not told
    std::vector<Light> added;         ///< those that no picture shows
    std::vector<glm::vec3> places_m;  ///< of all lamps that the search found, believed or not
};

/// Lamps that low exposure did not measure: those that it clipped, whose places are known, and those that it does not
/// show, which are searched for. They are fitted beside measured light, which tells how bright they are: not only up to
/// one factor, as where no light is known. While much of what is around is not known this is not sure, and lamps come
/// out too bright: then their tint is that of measured lamps, and one tenth of the surface keeps three quarters of
/// `white_albedo` or more; without low exposure it does so however much is known. Where hardly any light is known, it
/// begins at `white_albedo`. Never has more than a fifth of the surface an albedo an eighth above that. `clipped` are
/// these lamps, tried as ones that shine all around. A lamp that no picture shows, which may be flat,
/// is believed where a search before, of fewer frames, found it, too (`before_m`), or once most of what is around is
/// known. At most `most_added` are searched for. Nothing is told where the surface stays unexplained.
UnmeasuredLamps fit_unmeasured_lamps(const LitSurface& surface, const MeasuredLight& measured,
                                     std::span<const TrialLamp> clipped, std::span<const glm::vec3> before_m,
                                     const TryLamps& try_lamps, uint32_t most_added = LightSearchSettings().most_lamps);

struct ToldLamps {
    std::vector<FoundLight> lamps;    ///< clipped ones as bright as what they light tells, then unseen ones
    std::vector<glm::vec3> places_m;  ///< where this search and those before found lamps, believed or not
};

/// The same for what the pipeline has observed, beside `lamps`, which are as_measured(); `drawn` as draw_samples
/// returns it. Looks for nothing where nothing is missing: no lamp is clipped, and under the measured light no more
/// than a fifth of the surface has an albedo above 0.9. Waits for the device.
ToldLamps find_unmeasured_lamps(Pipeline& pipeline, std::vector<gpu::LightSample> drawn,
                                std::span<const FoundLight> lamps, std::span<const glm::vec3> before_m,
                                float white_albedo, bool low_exposure);

/// Lamps as the pictures of low exposure show them: without suns, and without what find_unmeasured_lamps() told.
std::vector<FoundLight> as_measured(std::vector<FoundLight> lamps);

}  // namespace patina
