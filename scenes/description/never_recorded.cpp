#include "scenes/description/never_recorded.h"

#include <utility>

#include "engine/core/error.h"
#include "scenes/description/clearance.h"
#include "scenes/description/draws.h"
#include "scenes/description/vary.h"

namespace patina::scenes {

namespace {

constexpr double kAside_m = 0.5, kHigher_m = 0.4;  // off the path
constexpr double kLeastAside_m = 0.25;             // else it is tried on the other side
constexpr double kAhead_m = 2;
constexpr double kKeep_m = 0.2;  // from everything

Waypoint beside(const RigidTransform& world_from_camera, const Clearance& clearance, double side, double higher_m) {
    const glm::dvec3 at_m(world_from_camera[3]), right(world_from_camera[0]);
    const auto on = [&](double which) {
        return clearance.reached(at_m, which * kAside_m * right + glm::dvec3(0, -higher_m, 0), kKeep_m);
    };
    glm::dvec3 position_m = on(side);
    if (glm::distance(position_m, at_m) < kLeastAside_m) {
        const glm::dvec3 other_m = on(-side);
        if (glm::distance(other_m, at_m) > glm::distance(position_m, at_m)) position_m = other_m;
    }
    return {position_m, at_m + kAhead_m * glm::dvec3(world_from_camera[2])};
}

}  // namespace

SyntheticScene with_novel_views(SyntheticScene scene, uint32_t count, double duration_s) {
    if (count < kFewestNovelViews) throw Error("novel views are ", count, ", must be at least ", kFewestNovelViews);
    Clearance clearance(scene.objects);
    for (const Light& light : scene.lights) clearance.add(light);
    // A tour is at its waypoints at equal times: at each frame's.
    WaypointPath path;
    path.period_s = count / scene.fps;
    for (uint32_t i = 0; i < count; ++i) {
        const RigidTransform pose = world_from_camera(scene.path, duration_s * (i + 0.5) / count);
        const double higher_m = Draws(0, "height of a novel view", i).between(-kHigher_m, kHigher_m);
        path.waypoints.push_back(beside(pose, clearance, i % 2 == 0 ? 1 : -1, higher_m));
    }
    scene.path = std::move(path);
    scene.recording.noise = {};
    return scene;
}

SyntheticScene with_other_light(SyntheticScene scene) {
    constexpr uint64_t kSeed = 0x6e657665725f7265;  // no seed that --vary is likely to be given
    return with_varied_light(std::move(scene), kSeed, 0.6);
}

}  // namespace patina::scenes
