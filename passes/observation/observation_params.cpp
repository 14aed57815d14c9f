#include "passes/observation/observation_params.h"

#include <cmath>

#include "engine/core/error.h"

namespace patina {

namespace {

void check_range(const char* name, double value, double least, double most) {
    if (!(value >= least && value <= most)) {
        throw Error("observation.", name, " is ", value, ", it must be ", least, " to ", most);
    }
}

void check(const ObservationSettings& settings) {
    check_range("stride_px", settings.stride_px, 1, 64);
    check_range("max_distance_m", settings.max_distance_m, 0, 1000);
    check_range("max_angle_degrees", settings.max_angle_degrees, 0, 90);
    check_range("depth_tolerance_m", settings.depth_tolerance_m, 0, 1);
    check_range("depth_tolerance_per_m2", settings.depth_tolerance_per_m2, 0, 1);
    check_range("edge_margin_px", settings.edge_margin_px, 0, 16);
    check_range("merge_angle_degrees", settings.merge_angle_degrees, 0, 90);
    check_range("max_blur_px", settings.max_blur_px, 0, 1e6);
    check_range("rest_px", settings.rest_px, 0, 1e6);
}

/// By how many pixels a point 1 m away moved at most, about.
double moved_px(const gpu::Camera& camera, const CameraMotion& motion) {
    const glm::dmat4 before_from_now(motion.color_before_from_world * glm::inverse(camera.camera_from_world));
    const glm::dmat3 turn = glm::dmat3(before_from_now) - glm::dmat3(1);
    const double turned =
        std::sqrt((glm::dot(turn[0], turn[0]) + glm::dot(turn[1], turn[1]) + glm::dot(turn[2], turn[2])) / 2);
    return double{camera.focal_center_px.x} * (glm::length(glm::dvec3(before_from_now[3])) + turned);
}

}  // namespace

gpu::ObservationParams make_observation_params(const ObservationMap& map, const ObservationSettings& settings,
                                               const gpu::Camera& depth_camera, const gpu::Camera& color_camera,
                                               uint32_t frame_index, const std::optional<CameraMotion>& motion) {
    check(settings);
    const bool rests = motion && moved_px(color_camera, *motion) < double{settings.rest_px};
    const uint32_t stride_px = rests ? 2 * settings.stride_px : settings.stride_px;
    gpu::ObservationParams params{};
    params.grid = map.grid();
    params.depth_camera = depth_camera;
    params.color_camera = color_camera;
    params.color_before_from_world = motion ? motion->color_before_from_world : color_camera.camera_from_world;
    params.shutter_share = motion ? motion->shutter_share : 0;
    params.stride_px = stride_px;
    params.visited = (depth_camera.extent + stride_px - 1u) / stride_px;
    params.phase = frame_index * 5u % (stride_px * stride_px);
    params.edge_shift = map.edge_shift();
    params.record_capacity = map.capacity_records();
    params.max_table_keys = map.table_slots() / 2;
    params.stamp = frame_index + 1;
    params.max_distance_m = settings.max_distance_m;
    params.min_cosine = static_cast<float>(std::cos(glm::radians(double{settings.max_angle_degrees})));
    params.depth_tolerance_m = settings.depth_tolerance_m;
    params.depth_tolerance_per_m2 = settings.depth_tolerance_per_m2;
    const double chord =
        2 * std::sin(glm::radians(double{settings.merge_angle_degrees}) / 2) * double{gpu::kDirectionSteps};
    params.merge_distance2 = static_cast<float>(chord * chord);
    params.edge_margin_px = settings.edge_margin_px;
    // As add_measure_slope: what a grazing surface changes by between pixels is less, what objects are apart is more.
    params.jump_m = 0.01f;
    params.jump_slope = 0.015f;
    params.max_blur_px = settings.max_blur_px;
    params.smeared_observations = settings.smeared_observations;
    return params;
}

}  // namespace patina
