#pragma once

#include <array>
#include <map>

#include <glm/glm.hpp>

namespace patina::reference {

/// What is known of a voxel's record.
struct Coverage {
    double observations = 0;
    double certainty = 0;  ///< of the albedo's least sure channel
};

/// The trilinear mean over those of the eight voxels around a point that have a record; zero where none has.
Coverage sample_coverage(const std::map<std::array<int, 3>, Coverage>& records, double voxel_m, glm::dvec3 point_m);

}  // namespace patina::reference
