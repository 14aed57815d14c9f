// The part of Reconstruction that finds the poses of frames.
#include <algorithm>
#include <cmath>

#include "engine/core/shader_camera.h"
#include "passes/fusion/shade_color.h"
#include "passes/fusion/visible_blocks.h"
#include "passes/reconstruction.h"
#include "passes/tracking/hide_highlights.h"

namespace patina {

namespace {

/// A camera that tracks weakly for so many frames may be somewhere else altogether.
constexpr uint32_t kWeakFrames = 4;

/// How many pixels of a depth picture hold a reading.
size_t readings_of(const DepthInput& depth) {
    const auto is_reading = [](auto pixel) { return pixel > 0 && std::isfinite(static_cast<float>(pixel)); };
    return static_cast<size_t>(std::visit(
        [&](const auto& pixels) { return std::count_if(pixels.begin(), pixels.end(), is_reading); }, depth.pixels));
}

}  // namespace

TrackingReport Reconstruction::start_tracking(const RgbdFrame& frame) {
    const size_t readings = readings_of(frame.depth), least = tracking_->settings().bounds.least_pairs;
    TrackingReport report;
    report.world_from_depth = frame.world_from_depth;
    if (readings >= least) {
        report.state = TrackingState::kTracking;
    } else {
        report.reason = text("the first frame has ", readings, " readings, fewer than ", least);
    }
    tracking_->accept(report, frame.time, true);
    return report;
}

TrackingReport Reconstruction::search(graph::Frame graph, const InputPictures& pictures, const RgbdFrame& frame,
                                      const RigidTransform& start) {
    const bool shaded = settings_.fusion.color && tracking_->settings().photometric;
    const TrackColor color{pictures.color, frame.color.camera, frame.color_from_depth};
    const auto pyramid =
        tracking_->add_pyramid(graph, pictures.depth_m, frame.depth.camera,
                               shaded ? std::optional(color) : std::nullopt, settings_.fusion.max_depth_m);
    const TrackingModel::Search search = tracking_->add_search(graph, pyramid, start);
    runner_.submit(std::move(graph));
    runner_.wait();
    return tracking_->report_of(search);
}

/// From one more start, with the pictures of the frame's first search.
TrackingReport Reconstruction::search_again(const RgbdFrame& frame, const RigidTransform& start) {
    graph::Frame graph = runner_.begin();
    const InputPictures pictures = tracking_->pictures().import(graph);
    return search(std::move(graph), pictures, frame, start);
}

/// From where the motion so far leads to; the frame before is fused in the first search's graph.
TrackingReport Reconstruction::best_search(const RgbdFrame& frame) {
    const std::vector<RigidTransform> starts = tracking_->expected(frame.time);
    graph::Frame graph = waiting_ ? begin_fusing() : runner_.begin();
    std::optional<PendingCounts> fused;
    if (waiting_) fused = add_waiting(graph);
    const InputPictures pictures = tracking_->pictures().add(graph, frame.depth, frame.color);
    TrackingReport best = search(std::move(graph), pictures, frame, starts.front());
    if (fused) {
        pools_->await(frames_, fused->pools);
        note_waiting_fused(*std::move(fused));
    }
    for (size_t i = 1; i < starts.size() && best.state == TrackingState::kLost; ++i) {
        const TrackingReport report = search_again(frame, starts[i]);
        if (report.state < best.state) best = report;
    }
    return best;
}

TrackingReport Reconstruction::track(const RgbdFrame& frame) {
    TrackingReport best = best_search(frame);
    bool jumped = false;
    weak_frames_ = best.state == TrackingState::kWeak ? weak_frames_ + 1 : 0;
    if (best.state == TrackingState::kLost || (weak_frames_ > 0 && weak_frames_ % kWeakFrames == 0)) {
        if (const auto found = relocalised(frame)) {
            best = *found;
            jumped = true;
        }
    }
    tracking_->accept(best, frame.time, jumped);
    // What is fused brings its own reference.
    if (best.state == TrackingState::kWeak) cast_reference(frame.depth.camera, best.world_from_depth);
    return best;
}

std::vector<RigidTransform> Reconstruction::candidates(const RgbdFrame& frame) {
    if (relocaliser_) return relocaliser_(frame);
    std::vector<RigidTransform> poses;
    if (!keyframes_ || frames_ == 0) return poses;
    graph::Frame graph = runner_.begin();
    const InputPictures pictures = tracking_->pictures().import(graph);
    const graph::Readback lookup = keyframes_->add_lookup(graph, pictures.depth_m, pictures.color);
    runner_.submit(std::move(graph));
    runner_.wait();
    for (const KeyframePose& pose : KeyframeModel::candidates_of(lookup)) poses.push_back(pose.world_from_depth);
    return poses;
}

TrackingReport Reconstruction::search_from(const RgbdFrame& frame, const RigidTransform& start) {
    cast_reference(frame.depth.camera, start);
    return search_again(frame, start);
}

std::optional<TrackingReport> Reconstruction::relocalised(const RgbdFrame& frame) {
    const RigidTransform before = tracking_->world_from_reference();
    const std::vector<RigidTransform> starts = candidates(frame);
    for (const RigidTransform& start : starts) {
        TrackingReport report = search_from(frame, start);
        // From afar it may not have settled, or the view from the start showed too little of what the frame does.
        if (report.state == TrackingState::kWeak) report = search_from(frame, report.world_from_depth);
        if (report.state == TrackingState::kTracking && report.share >= tracking_->settings().bounds.jump_share)
            return report;
    }
    if (!starts.empty()) cast_reference(frame.depth.camera, before);
    return std::nullopt;
}

void Reconstruction::add_posed(const RgbdFrame& frame) {
    check(frame);
    fuse_waiting();
    if (tracking_) {
        TrackingReport report;
        report.state = TrackingState::kTracking;
        report.world_from_depth = frame.world_from_depth;
        tracking_->accept(report, frame.time, true);
    }
    fuse_posed(frame);
}

gpu::KeyframeCounters Reconstruction::keyframe_counters() {
    if (!keyframes_ || frames_ == 0) return {};
    fuse_waiting();
    graph::Frame graph = runner_.begin();
    const graph::Readback read = keyframes_->read_counters(graph);
    runner_.submit(std::move(graph));
    runner_.wait();
    return read.as<gpu::KeyframeCounters>().front();
}

void Reconstruction::cast_reference(const Intrinsics& camera, const RigidTransform& world_from_depth) {
    graph::Frame graph = runner_.begin();
    const VoxelMapIds ids = map_.import(graph);
    const VisibleBlocks visible =
        add_visible_blocks(graph, map_, ids, make_camera(camera, world_from_depth), settings_.near_m, far_m());
    keep_reference(graph, ids, visible, add_raycast(graph, map_, ids, visible, access_), camera, world_from_depth);
    runner_.submit(std::move(graph));
}

void Reconstruction::keep_reference(graph::Frame& graph, const VoxelMapIds& ids, const VisibleBlocks& visible,
                                    const RaycastImages& model, const Intrinsics& camera,
                                    const RigidTransform& world_from_depth) {
    std::optional<graph::ImageId> color;
    if (settings_.fusion.color && tracking_->settings().photometric)
        color = add_shade_color(graph, map_, ids, visible, model.position_m);
    if (color && reflectance_ && tracking_->settings().hide_highlights) {
        const PredictedImages seen = reflectance_->add_predict(graph, ids, visible, model).images;
        color = add_hide_highlights(graph, {*color, seen.kd, seen.light, seen.rgb});
    }
    tracking_->add_reference(graph, model, color, camera, world_from_depth);
}

}  // namespace patina
