#include "tests/reference/fusion/raycast.h"

#include <cmath>

namespace patina::reference {

namespace {

double first_crossing(const Volume& volume, glm::dvec3 eye, glm::dvec3 ray, double near_m, double far_m) {
    const double step = 0.2 * volume.voxel_m / glm::length(ray);
    std::optional<double> before;
    for (double depth = near_m; depth <= far_m; depth += step) {
        const std::optional<double> here = volume.distance_at(eye + ray * depth);
        if (here && before && *before > 0 && *here <= 0) return depth - step * *here / (*here - *before);
        before = here;
    }
    return 0;
}

}  // namespace

Image<float> raycast(const Volume& volume, const Intrinsics& camera, const RigidTransform& world_from_camera,
                     double near_m, double far_m) {
    Image<float> depth_m(camera.extent);
    const glm::dmat3 rotation(world_from_camera);
    for (uint32_t y = 0; y < camera.extent.height; ++y) {
        for (uint32_t x = 0; x < camera.extent.width; ++x) {
            const glm::dvec3 ray = rotation * glm::dvec3((x - camera.cx) / camera.fx, (y - camera.cy) / camera.fy, 1);
            const glm::dvec3 eye(world_from_camera[3]);
            depth_m.at(x, y) = static_cast<float>(first_crossing(volume, eye, ray, near_m, far_m));
        }
    }
    return depth_m;
}

}  // namespace patina::reference
