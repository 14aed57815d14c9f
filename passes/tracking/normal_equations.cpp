#include "passes/tracking/normal_equations.h"

#include "engine/core/divided_up.h"
#include "engine/core/error.h"
#include "shared/tracking/tracking.h"
#include "spirv/shaders.h"

namespace patina {

namespace {

void check(const TrackErrors& errors) {
    const auto check_positive = [](const char* name, float value) {
        if (!(value > 0)) throw Error("tracking.", name, " is ", value, ", it must be above 0");
    };
    check_positive("noise_floor_m", errors.noise_floor_m);
    check_positive("robust_sigmas", errors.robust_sigmas);
    check_positive("gate_m", errors.gate_m);
    check_positive("robust_shade", errors.robust_shade);
}

glm::vec4 focal_center_px(const Intrinsics& camera) { return {camera.fx, camera.fy, camera.cx, camera.cy}; }

/// Rows of an invocation, so that as few groups as may be cover the height, and little more than it.
uint32_t rows_of(uint32_t height) {
    const uint32_t groups = divided_up(height, gpu::kNormalEquationsGroupY * gpu::kNormalEquationsMostRows);
    return divided_up(height, groups * gpu::kNormalEquationsGroupY * gpu::kNormalEquationsUnrolled) *
           gpu::kNormalEquationsUnrolled;
}

}  // namespace

NormalEquations add_normal_equations(graph::FrameGraph& frame, const TrackLevel& own, const TrackLevel& model,
                                     graph::BufferId state, const TrackErrors& errors, uint32_t coarser) {
    check(errors);
    const auto widened = static_cast<float>(1u << coarser);
    gpu::NormalEquationsParams params{};
    params.frame_focal_center_px = focal_center_px(own.camera);
    params.model_focal_center_px = focal_center_px(model.camera);
    params.frame_extent = {own.camera.extent.width, own.camera.extent.height};
    params.model_extent = {model.camera.extent.width, model.camera.extent.height};
    params.gate_m = errors.gate_m * widened;
    params.gate_slope = errors.gate_slope * widened;
    params.noise_floor_m = errors.noise_floor_m;
    params.noise_per_m = errors.noise_per_m;
    params.robust_sigmas = errors.robust_sigmas * widened;
    params.shade_sigma = errors.shade_sigma;
    params.robust_shade = errors.robust_shade;
    params.rows = rows_of(own.camera.extent.height);
    const uint32_t groups_x = divided_up(own.camera.extent.width, gpu::kTrackGroupX);
    const uint32_t groups_y = divided_up(own.camera.extent.height, gpu::kNormalEquationsGroupY * params.rows);
    // By size, so that profiles tell levels apart.
    auto pass =
        frame.compute(text("tracking.normal_equations_", own.camera.extent.width, "x", own.camera.extent.height),
                      spirv::normal_equations);
    pass.read("frame_pixels", own.pixels).read("model_pixels", model.pixels).read("State", state).push(params);
    pass.specialise("kShaded", errors.shade_sigma > 0 ? 1 : 0);
    NormalEquations equations;
    equations.groups = groups_x * groups_y;
    equations.sums = pass.create("Sums", uint64_t{equations.groups} * gpu::kTrackSums * sizeof(float));
    pass.dispatch(groups_x, groups_y);
    return equations;
}

graph::BufferId add_solve_motion(graph::FrameGraph& frame, const NormalEquations& equations, graph::BufferId state,
                                 float held_share, float least_pairs) {
    auto pass = frame.compute("tracking.solve_motion", spirv::solve_motion);
    pass.read("Sums", equations.sums);
    const graph::BufferId moved = pass.modify("State", state);
    pass.push(gpu::SolveMotionParams{equations.groups, held_share, least_pairs, 0});
    pass.dispatch(1);
    return moved;
}

}  // namespace patina
