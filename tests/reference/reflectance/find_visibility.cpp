#include "tests/reference/reflectance/find_visibility.h"

#include <algorithm>

namespace patina::reference {

double least_distance_m(const Volume& volume, glm::dvec3 from_m, glm::dvec3 to_m) {
    constexpr double kFar = 1e3;
    double least = kFar;
    const int steps = static_cast<int>(glm::distance(from_m, to_m) / (0.5 * volume.voxel_m)) + 1;
    for (int i = 0; i <= steps; ++i) {
        const double share = static_cast<double>(i) / steps;
        least = std::min(least, volume.distance_at(glm::mix(from_m, to_m, share)).value_or(kFar));
    }
    return least;
}

}  // namespace patina::reference
