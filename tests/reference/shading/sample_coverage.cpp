#include "tests/reference/shading/sample_coverage.h"

#include <cmath>

namespace patina::reference {

Coverage sample_coverage(const std::map<std::array<int, 3>, Coverage>& records, double voxel_m, glm::dvec3 point_m) {
    Coverage sum;
    double shares = 0;
    const glm::dvec3 at = point_m / voxel_m;
    for (const auto& [voxel, record] : records) {
        double share = 1;
        for (int axis = 0; axis < 3; ++axis)
            share *= std::max(0.0, 1 - std::abs(voxel[static_cast<size_t>(axis)] + 0.5 - at[axis]));
        sum.observations += share * record.observations;
        sum.certainty += share * record.certainty;
        shares += share;
    }
    if (shares == 0) return {};
    return {sum.observations / shares, sum.certainty / shares};
}

}  // namespace patina::reference
