#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "patina/scene.h"

namespace patina {

/// A connected part of a surface that a plane shows without folds, in orthographic projection.
struct Chart {
    std::vector<uint32_t> triangles;          ///< of the mesh, each in one chart
    glm::vec3 right{1, 0, 0}, down{0, 1, 0};  ///< axes of the plane, unit length; across them the surface faces
    glm::vec2 low_m{0}, size_m{0};            ///< of the box around the chart, along both
};

/// Divides a mesh into charts. A chart grows from the largest triangle that is left over its neighbours, as long as
/// they face within 60 degrees of its plane, lie beside what it has, and fit into a square of `most_m`; a larger
/// triangle is a chart of its own. Then the plane is turned to what the chart faces on average, and it grows once more.
/// A box around a chart has the least area. The same mesh gives the same charts.
std::vector<Chart> find_charts(const Mesh& mesh, double most_m);

}  // namespace patina
