#include "tests/reference/observation/reclaim_records.h"

#include <cmath>

namespace patina::reference {

std::set<std::array<int, 3>> with_surface(const Volume& volume, const std::vector<std::array<int, 3>>& observed,
                                          double observed_voxel_m, double near_m) {
    const int edge = static_cast<int>(std::lround(observed_voxel_m / volume.voxel_m));
    const auto holds_surface = [&](const std::array<int, 3>& at) {
        for (int z = 0; z < edge; ++z) {
            for (int y = 0; y < edge; ++y) {
                for (int x = 0; x < edge; ++x) {
                    const Voxel* voxel = volume.find({at[0] * edge + x, at[1] * edge + y, at[2] * edge + z});
                    if (voxel && voxel->weight > 0 && std::abs(voxel->sdf_m) < near_m) return true;
                }
            }
        }
        return false;
    };
    std::set<std::array<int, 3>> kept;
    for (const std::array<int, 3>& at : observed) {
        if (holds_surface(at)) kept.insert(at);
    }
    return kept;
}

}  // namespace patina::reference
