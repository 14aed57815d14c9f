#pragma once

#include <array>
#include <set>
#include <vector>

#include "tests/reference/fusion/volume.h"

namespace patina::reference {

/// Of these observation voxels (voxel v spans [v, v + 1) times `observed_voxel_m` from the world's origin), those that
/// hold a voxel of the volume which was seen, nearer than `near_m` to the surface. An observation voxel's edge is a
/// whole number of the volume's voxels.
std::set<std::array<int, 3>> with_surface(const Volume& volume, const std::vector<std::array<int, 3>>& observed,
                                          double observed_voxel_m, double near_m);

}  // namespace patina::reference
