#include "reconstruction/frame_context.h"

#include <algorithm>
#include <cmath>

#include "engine/core/error.h"
#include "engine/core/shader_camera.h"
#include "passes/input/convert_color.h"
#include "passes/input/convert_depth.h"

namespace patina {

namespace {

template <class Pixels>
void check_size(const char* what, const Pixels& pixels, const Intrinsics& camera) {
    const size_t count = std::visit([](const auto& span) { return span.size(); }, pixels);
    if (count != camera.extent.area()) {
        throw Error("the ", what, " picture has ", count, " pixels, its camera ", camera.extent);
    }
}

}  // namespace

PosedCamera make_posed_camera(const Intrinsics& intrinsics, const RigidTransform& world_from_camera) {
    return {intrinsics, world_from_camera, make_camera(intrinsics, world_from_camera)};
}

PosedCamera resized(const PosedCamera& camera, Extent2D extent) {
    return make_posed_camera(scaled_to(camera.intrinsics, extent), camera.world_from_camera);
}

FrameCameras make_frame_cameras(const RgbdFrame& frame) {
    return {make_posed_camera(frame.depth.camera, frame.world_from_depth),
            make_posed_camera(frame.color.camera, frame.world_from_depth * rigid_inverse(frame.color_from_depth))};
}

uint32_t FrameContext::stride_px(uint32_t most_px, double cell_m) const {
    if (first()) return 1;
    const double usual_m = 3.0 / 8 * double{range.reach_m};
    const double fits = cell_m * depth.intrinsics.fx / usual_m;
    return static_cast<uint32_t>(std::clamp(fits, 1.0, static_cast<double>(std::max(most_px, 1u))));
}

void FrameHistory::note(const FrameContext& frame) {
    world_from_color = frame.color.world_from_camera;
    ++frames;
    if (frame.precedes) ++preceding;
    if (frame.fuses_color) ++color_frames;
}

FrameContext make_frame_context(const RgbdFrame& frame, const FrameHistory& before, const DepthRange& range,
                                bool fuses_color) {
    FrameContext context;
    context.index = before.frames;
    context.preceding = before.preceding;
    context.color_index = before.color_frames;
    const FrameCameras cameras = make_frame_cameras(frame);
    context.depth = cameras.depth;
    context.color = cameras.color;
    context.range = range;
    if (before.world_from_color) {
        const PosedCamera last = make_posed_camera(frame.color.camera, *before.world_from_color);
        context.motion = {last.gpu.camera_from_world, frame.shutter_share};
    }
    context.fuses_color = fuses_color && !frame.held_out;
    context.held_out = frame.held_out;
    context.labels = frame.labels;
    return context;
}

void check_frame(const RgbdFrame& frame, uint32_t number) {
    check_size("depth", frame.depth.pixels, frame.depth.camera);
    check_size("colour", frame.color.pixels, frame.color.camera);
    check_depth(frame.depth);
    check_color(frame.color);
    if (!frame.labels.empty() && frame.labels.size() != frame.depth.camera.extent.area()) {
        throw Error("the label picture has ", frame.labels.size(), " pixels, the depth camera ",
                    frame.depth.camera.extent);
    }
    // Readers orthonormalise poses; what is left is rounding.
    const double defect = rotation_defect(frame.world_from_depth);
    if (!(defect < 1e-3)) throw Error("the pose of frame ", number, " is not rigid: its rotation is off by ", defect);
}

void check_view(const Intrinsics& camera, const RigidTransform& world_from_camera) {
    const bool finite = std::isfinite(camera.fx + camera.fy + camera.cx + camera.cy);
    if (camera.extent.area() == 0 || !finite || camera.fx <= 0 || camera.fy <= 0) {
        throw Error("the view's camera is not usable: ", camera.extent, " pixels, fx ", camera.fx, ", fy ", camera.fy,
                    ", cx ", camera.cx, ", cy ", camera.cy);
    }
    const double defect = rotation_defect(world_from_camera);
    if (!(defect < 1e-3)) throw Error("the view's pose is not rigid: its rotation is off by ", defect);
}

}  // namespace patina
