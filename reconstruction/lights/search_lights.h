#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "reconstruction/lights/fit_intensities.h"

namespace patina {

struct LightSearchSettings {
    uint32_t most_lamps = 6;
    float highlight_share = 0.5f;  ///< what unexplained highlights count beside the misfit of diffuse light
    float least_gain = 0.12f;      ///< a lamp makes the sum of both smaller by this share, or is left out
    float expected_gain = 0.12f;   ///< the same of a lamp that is found where one is expected
    float flat_gain = 0.03f;       ///< a flat lamp makes it smaller by this share than one that shines all around
};

/// A lamp's place, what it gives the samples, and how badly it explains each highlight.
struct TrialLamp {
    glm::vec3 place_m{0};
    ReceivedLight received;
    std::vector<float> unexplained;
    glm::vec3 axis{0};  ///< as Light's
};

/// A lamp that was tried as one that shines all around, as a flat one with this axis.
TrialLamp as_flat(const LitSurface& surface, const TrialLamp& all_around, glm::vec3 axis);

/// What lamps at these places would give the samples of a surface; of the first `count` places of samples only, if that
/// is all that is asked for.
using TryLamps = std::function<std::vector<TrialLamp>(std::span<const glm::vec3> places_m, uint32_t count)>;

/// Share of the surface's highlights that none of the lamps explains; 0 where there are no highlights. Lamps that give
/// the surface less than a hundredth of its light, by `intensities`, explain none.
double unexplained_highlights(const LitSurface& surface, std::span<const TrialLamp> lamps,
                              std::span<const double> intensities);

/// Light of which not all is known.
struct GivenLight {
    std::vector<ReceivedLight> lights;  ///< only the strength is not, one by one
    ReceivedLight ambient;              ///< the same; null: 1 for all samples
    std::vector<TrialLamp> lamps;       ///< their places are known; tried as lamps that shine all around
};

/// Whether two lamps may be the same one, found twice: nearer to each other than a third of the way to the middle of
/// the surface.
bool is_same_place(const LitSurface& surface, glm::vec3 a_m, glm::vec3 b_m);

/// Finds lamps that explain a surface: one after the other from a lattice around it and from `seen_m`, where lamps are
/// expected, all moved and turned to better places and axes whenever there is a new one; then those that matter too
/// little are left out. `try_lamps` tries lamps that shine all around. Given lamps come first in what is returned: none
/// is left out or moved, but each may turn out to be flat.
std::vector<TrialLamp> search_lights(const LitSurface& surface, const TryLamps& try_lamps,
                                     std::span<const glm::vec3> seen_m, const LightSearchSettings& settings,
                                     const GivenLight& given = {});

}  // namespace patina
