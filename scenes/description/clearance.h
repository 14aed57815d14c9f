#pragma once

#include <span>
#include <vector>

#include "scenes/description/scene.h"

namespace patina::scenes {

/// How much room there is around points of a scene.
class Clearance {
  public:
    explicit Clearance(std::span<const SceneObject> objects);

    /// Keeps clear of a sphere-shaped lamp as well.
    void add(const Light& lamp);

    /// The distance from a point in the world to the nearest surface, from inside and outside alike; infinite without
    /// any. A mesh counts as its bounding box, filled: 0 inside.
    double at(glm::dvec3 point_m) const;

    /// How far something gets from `from_m` along `way_m` that keeps `keep_m` from all surfaces and passes through
    /// none: in steps as long as the room that is left.
    glm::dvec3 reached(glm::dvec3 from_m, glm::dvec3 way_m, double keep_m) const;

  private:
    struct Obstacle {
        Shape shape;
        bool filled;
        RigidTransform part_from_world;
    };

    std::vector<Obstacle> obstacles_;
};

}  // namespace patina::scenes
