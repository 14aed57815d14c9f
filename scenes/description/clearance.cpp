#include "scenes/description/clearance.h"

#include <algorithm>
#include <cmath>

#include <glm/gtc/matrix_transform.hpp>

namespace patina::scenes {
namespace {

// Signed distances to shapes, negative inside.

template <class Vector>
double to_region(Vector beyond) {
    double nearest_m = -INFINITY;
    for (int i = 0; i < Vector::length(); ++i) nearest_m = std::max(nearest_m, beyond[i]);
    return nearest_m < 0 ? nearest_m : glm::length(glm::max(beyond, Vector(0)));
}

struct SignedDistance {
    glm::dvec3 p;

    double operator()(const RectangleShape& s) const { return to_region(glm::abs(p) - glm::dvec3(s.half_size_m, 0)); }
    double operator()(const BoxShape& s) const { return to_region(glm::abs(p) - s.half_size_m); }
    double operator()(const SphereShape& s) const { return glm::length(p) - s.radius_m; }
    double operator()(const CylinderShape& s) const {
        return to_region(glm::dvec2(std::hypot(p.x, p.z) - s.radius_m, std::abs(p.y) - s.half_height_m));
    }
    double operator()(const MeshShape&) const { return INFINITY; }  // its bounding box stands for it
};

/// The bounding box of a mesh, and its centre.
std::pair<BoxShape, glm::dvec3> bounding_box(const TriangleMesh& mesh) {
    glm::dvec3 low(INFINITY), high(-INFINITY);
    for (const glm::vec3 corner : mesh.positions_m) {
        low = glm::min(low, glm::dvec3(corner));
        high = glm::max(high, glm::dvec3(corner));
    }
    return {BoxShape{(high - low) / 2.0}, (low + high) / 2.0};
}

}  // namespace

Clearance::Clearance(std::span<const SceneObject> objects) {
    for (const SceneObject& object : objects) {
        for (const Part& part : object.parts) {
            if (const auto* mesh = std::get_if<MeshShape>(&part.shape)) {
                const auto [box, center_m] = bounding_box(*mesh->mesh);
                obstacles_.push_back({box, true, rigid_inverse(glm::translate(part.world_from_part, center_m))});
            } else {
                obstacles_.push_back({part.shape, false, rigid_inverse(part.world_from_part)});
            }
        }
    }
}

void Clearance::add(const Light& lamp) {
    if (lamp.radius_m == 0) return;
    obstacles_.push_back({SphereShape{lamp.radius_m}, true, glm::translate(RigidTransform(1.0), -lamp.position_m)});
}

double Clearance::at(glm::dvec3 point_m) const {
    double least_m = INFINITY;
    for (const Obstacle& obstacle : obstacles_) {
        const SignedDistance signed_distance{glm::dvec3(obstacle.part_from_world * glm::dvec4(point_m, 1))};
        const double distance_m = std::visit(signed_distance, obstacle.shape);
        least_m = std::min(least_m, obstacle.filled ? std::max(distance_m, 0.0) : std::abs(distance_m));
    }
    return least_m;
}

glm::dvec3 Clearance::reached(glm::dvec3 from_m, glm::dvec3 way_m, double keep_m) const {
    const double length_m = glm::length(way_m);
    double gone_m = 0;
    for (int step = 0; step < 64 && gone_m < length_m; ++step) {
        const double free_m = at(from_m + way_m * (gone_m / length_m)) - keep_m;
        if (!(free_m > 1e-4)) break;
        gone_m = std::min(length_m, gone_m + free_m);
    }
    return length_m > 0 ? from_m + way_m * (gone_m / length_m) : from_m;
}

}  // namespace patina::scenes
