#include "tests/scenes/part_box.h"

#include <algorithm>
#include <cmath>

namespace patina::scenes {
namespace {

struct ShapeBounds {
    glm::dvec3 low{INFINITY};
    glm::dvec3 high{-INFINITY};
};

ShapeBounds bounds_of(const Shape& shape) {
    struct {
        ShapeBounds operator()(const RectangleShape& s) const { return around({s.half_size_m, 0}); }
        ShapeBounds operator()(const BoxShape& s) const { return around(s.half_size_m); }
        ShapeBounds operator()(const SphereShape& s) const { return around(glm::dvec3(s.radius_m)); }
        ShapeBounds operator()(const CylinderShape& s) const {
            return around({s.radius_m, s.half_height_m, s.radius_m});
        }
        ShapeBounds operator()(const MeshShape& s) const {
            ShapeBounds bounds;
            for (const glm::vec3& p : s.mesh->positions_m)
                bounds = {glm::min(bounds.low, glm::dvec3(p)), glm::max(bounds.high, glm::dvec3(p))};
            return bounds;
        }
        static ShapeBounds around(glm::dvec3 half_size_m) { return {-half_size_m, half_size_m}; }
    } visitor;
    return std::visit(visitor, shape);
}

/// The directions among which two boxes have a separating one, if any: face normals and cross products of edges.
std::vector<glm::dvec3> candidate_axes(const PartBox& a, const PartBox& b) {
    std::vector<glm::dvec3> axes;
    for (int i = 0; i < 3; ++i) {
        axes.push_back(a.axes[i]);
        axes.push_back(b.axes[i]);
        for (int j = 0; j < 3; ++j) {
            const glm::dvec3 across = glm::cross(a.axes[i], b.axes[j]);
            if (glm::length(across) > 1e-6) axes.push_back(glm::normalize(across));
        }
    }
    return axes;
}

double reach_m(const PartBox& box, glm::dvec3 axis) {
    return glm::dot(glm::abs(glm::transpose(box.axes) * axis), box.half_size_m);
}

}  // namespace

std::vector<glm::dvec3> PartBox::corners() const {
    std::vector<glm::dvec3> points;
    for (int i = 0; i < 8; ++i) {
        const glm::dvec3 sign((i & 1) ? 1 : -1, (i & 2) ? 1 : -1, (i & 4) ? 1 : -1);
        points.push_back(center_m + axes * (sign * half_size_m));
    }
    return points;
}

PartBox box_around(const Part& part) {
    const ShapeBounds bounds = bounds_of(part.shape);
    const glm::dvec3 middle = (bounds.low + bounds.high) / 2.0;
    return {glm::dvec3(part.world_from_part * glm::dvec4(middle, 1)), glm::dmat3(part.world_from_part),
            (bounds.high - bounds.low) / 2.0};
}

double overlap_m(const PartBox& a, const PartBox& b) {
    double least = INFINITY;
    for (const glm::dvec3& axis : candidate_axes(a, b)) {
        const double apart = std::abs(glm::dot(b.center_m - a.center_m, axis));
        least = std::min(least, reach_m(a, axis) + reach_m(b, axis) - apart);
    }
    return least;
}

double overlap_m(const SceneObject& a, const SceneObject& b) {
    double most = -INFINITY;
    for (const Part& part : a.parts)
        for (const Part& other : b.parts) most = std::max(most, overlap_m(box_around(part), box_around(other)));
    return most;
}

}  // namespace patina::scenes
