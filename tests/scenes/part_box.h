#pragma once

#include <vector>

#include <glm/glm.hpp>

#include "scenes/description/scene.h"

namespace patina::scenes {

/// The box around a part, its sides along the part's axes.
struct PartBox {
    glm::dvec3 center_m{0};  ///< world
    glm::dmat3 axes{1};      ///< unit vectors of its sides, world
    glm::dvec3 half_size_m{0};

    std::vector<glm::dvec3> corners() const;  ///< world
};

PartBox box_around(const Part& part);

/// By how much two boxes overlap along the direction in which they overlap least; negative: the gap between them along
/// the direction in which it is widest. 0 where they touch.
double overlap_m(const PartBox& a, const PartBox& b);

/// The largest overlap between the parts of two objects.
double overlap_m(const SceneObject& a, const SceneObject& b);

}  // namespace patina::scenes
