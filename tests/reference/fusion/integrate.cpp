#include "tests/reference/fusion/integrate.h"

#include <algorithm>
#include <cmath>

namespace patina::reference {

namespace {

/// Where a world point appears in a camera, as a whole pixel and the rest.
struct Projection {
    uint32_t x = 0, y = 0;
    glm::dvec2 rest{0};
    double depth_m = 0;
};

std::optional<Projection> project_into(const Intrinsics& camera, const RigidTransform& world_from_camera,
                                       glm::dvec3 world_m) {
    const glm::dvec3 point(rigid_inverse(world_from_camera) * glm::dvec4(world_m, 1));
    if (point.z <= 1e-3) return {};
    const glm::dvec2 pixel = project(camera, point), nearest = glm::floor(pixel + 0.5);
    if (nearest.x < 0 || nearest.y < 0 || nearest.x >= camera.extent.width || nearest.y >= camera.extent.height) {
        return {};
    }
    return Projection{static_cast<uint32_t>(nearest.x), static_cast<uint32_t>(nearest.y), pixel - nearest, point.z};
}

void integrate_color(Voxel& voxel, glm::dvec3 center_m, const Observation::Color& color, const Fusion& fusion) {
    const auto at = project_into(color.camera, color.world_from_camera, center_m);
    if (!at) return;
    const glm::dvec4 seen(color.linear.at(at->x, at->y));
    if (seen.a == 0) return;
    const double weight = std::min(voxel.weight, fusion.max_color_weight);
    const double share = voxel.colored ? std::min(fusion.frontal_weight / weight, 1.0) : 1;
    voxel.color += (glm::dvec3(seen) - voxel.color) * share;
    voxel.colored = true;
}

/// Returns whether the voxel is near the surface that the frame shows.
bool integrate_distance(Voxel& voxel, glm::dvec3 center_m, const Observation& seen, const Fusion& fusion) {
    const auto at = project_into(seen.camera, seen.world_from_camera, center_m);
    if (!at) return false;
    const double reading = seen.depth_m.at(at->x, at->y);
    const Slope& slope = seen.slope.at(at->x, at->y);
    if (reading <= 0 || reading > fusion.max_depth_m || slope.plane_factor == 0) return false;
    const double truncation = fusion.truncation_m + fusion.truncation_slope * reading;
    const double in_front_m = reading + glm::dot(slope.depth_per_px, at->rest) - at->depth_m;
    if (in_front_m < -truncation) return false;

    const double pixel_m = at->depth_m / seen.camera.fx;
    const double most_m = slope.beside_edge ? std::min(pixel_m, truncation) : truncation;
    const double distance_m = std::min(in_front_m * slope.plane_factor, most_m);
    const double trust = std::clamp(1 + in_front_m / truncation, 0.0, 1.0);
    const double free_share = slope.beside_edge && in_front_m > pixel_m ? 0.25 : 1;
    const double weight =
        std::max(std::round(fusion.frontal_weight * free_share * slope.plane_factor * std::pow(trust, 1.5)), 1.0);
    voxel.sdf_m = (voxel.sdf_m * voxel.weight + distance_m * weight) / (voxel.weight + weight);
    voxel.weight = std::min(voxel.weight + weight, fusion.max_weight);
    return std::abs(distance_m) <= fusion.color_band_m;
}

}  // namespace

Voxel integrate(const Voxel& voxel, glm::dvec3 center_m, const Observation& seen, const Fusion& fusion) {
    Voxel updated = voxel;
    const bool near = integrate_distance(updated, center_m, seen, fusion);
    if (near && seen.color) integrate_color(updated, center_m, *seen.color, fusion);
    return updated;
}

size_t integrate(Volume& volume, const Observation& seen, const Fusion& fusion) {
    size_t waiting = 0;
    for (auto& [block, voxels] : volume.blocks) {
        std::vector<int> near;
        bool settled = true;
        for (int i = 0; i < 512; ++i) {
            Voxel& voxel = voxels[static_cast<size_t>(i)];
            if (!integrate_distance(voxel, volume.center_m(block, i), seen, fusion)) continue;
            near.push_back(i);
            settled = settled && voxel.weight >= fusion.settled_weight;
        }
        if (!seen.color || near.empty()) continue;
        const int64_t turn = int64_t{block[0]} + block[1] + block[2] + 2560 + fusion.color_frame;
        if (settled && turn % fusion.settled_color_every != 0) {
            ++waiting;
            continue;
        }
        for (const int i : near) {
            integrate_color(voxels[static_cast<size_t>(i)], volume.center_m(block, i), *seen.color, fusion);
        }
    }
    return waiting;
}

}  // namespace patina::reference
