#include "reconstruction/tracked_fusion.h"

#include <algorithm>
#include <cmath>

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

TrackedFusion::TrackedFusion(graph::Runner& runner, Stages& stages, PosedFusion& fusion)
    : runner_(runner), stages_(stages), tracking_(stages.tracking.value()), fusion_(fusion) {}

bool TrackedFusion::add(const RgbdFrame& frame) {
    const bool first = !tracking_.has_reference();
    const TrackingReport report = first ? judge_first(frame) : track(frame);
    if (first) tracking_.accept(report, frame.time, true);
    if (report.state != TrackingState::kTracking) return false;
    if (frame.only_track && !first) {
        cast_reference(frame.depth.camera, report.world_from_depth);
        return false;
    }
    if (first) {
        fusion_.add(frame);
    } else {
        let_wait(frame, report.world_from_depth);
    }
    return true;
}

void TrackedFusion::add_posed(const RgbdFrame& frame) {
    fuse_waiting();
    TrackingReport report;
    report.state = TrackingState::kTracking;
    report.world_from_depth = frame.world_from_depth;
    tracking_.accept(report, frame.time, true);
    elsewhere_ = false;
    fusion_.add(frame);
}

void TrackedFusion::let_wait(const RgbdFrame& frame, const RigidTransform& world_from_depth) {
    waiting_.emplace(Waiting{frame, {frame.labels.begin(), frame.labels.end()}});
    RgbdFrame& kept = waiting_->frame;
    kept.world_from_depth = world_from_depth;
    // The caller's pixels are gone when the frame has its turn.
    kept.depth.pixels = {};
    kept.color.pixels = {};
    kept.labels = waiting_->labels;
}

void TrackedFusion::fuse_waiting() {
    if (!waiting_) return;
    graph::FrameGraph graph = fusion_.begin(waiting_->frame);
    const PosedFusion::Declared declared = declare_waiting(graph);
    runner_.submit(std::move(graph));
    fusion_.note(declared);
    waiting_.reset();
}

PosedFusion::Declared TrackedFusion::declare_waiting(graph::FrameGraph& graph) {
    return fusion_.declare(graph, waiting_->frame, tracking_.pictures().import(graph));
}

TrackingReport TrackedFusion::judge_first(const RgbdFrame& frame) const {
    const size_t readings = readings_of(frame.depth), least = tracking_.settings().bounds.least_pairs;
    TrackingReport report;
    report.world_from_depth = frame.world_from_depth;
    if (readings >= least) {
        report.state = TrackingState::kTracking;
    } else {
        report.reason = text("the first frame has ", readings, " readings, fewer than ", least);
    }
    return report;
}

TrackingReport TrackedFusion::track(const RgbdFrame& frame) {
    if (elsewhere_) return find(frame);
    TrackingReport best = best_search(frame);
    bool jumped = false;
    weak_frames_ = best.state == TrackingState::kWeak ? weak_frames_ + 1 : 0;
    if (best.state == TrackingState::kLost || (weak_frames_ > 0 && weak_frames_ % kWeakFrames == 0)) {
        if (const auto found = relocalised(frame)) {
            best = *found;
            jumped = true;
        }
    }
    tracking_.accept(best, frame.time, jumped);
    // What is fused brings its own reference.
    if (best.state == TrackingState::kWeak) cast_reference(frame.depth.camera, best.world_from_depth);
    return best;
}

/// Wherever in the model it was taken.
TrackingReport TrackedFusion::find(const RgbdFrame& frame) {
    graph::FrameGraph graph = runner_.begin();
    tracking_.pictures().add(graph, frame.depth, frame.color);
    runner_.submit(std::move(graph));
    TrackingReport report;
    report.state = TrackingState::kLost;
    report.world_from_depth = tracking_.world_from_reference();
    report.reason = "no keyframe of the map shows what it does";
    if (const auto found = relocalised(frame)) {
        report = *found;
        elsewhere_ = false;
    }
    tracking_.accept(report, frame.time, true);
    return report;
}

/// From where the motion so far leads to.
TrackingReport TrackedFusion::best_search(const RgbdFrame& frame) {
    const std::vector<RigidTransform> starts = tracking_.expected(frame.time);
    TrackingReport best = first_search(frame, starts.front());
    for (size_t i = 1; i < starts.size() && best.state == TrackingState::kLost; ++i) {
        const TrackingReport report = search_again(frame, starts[i]);
        if (report.state < best.state) best = report;
    }
    return best;
}

/// In the same graph as this search the frame before is fused, which the search needs the model of.
TrackingReport TrackedFusion::first_search(const RgbdFrame& frame, const RigidTransform& start) {
    graph::FrameGraph graph = waiting_ ? fusion_.begin(waiting_->frame) : runner_.begin();
    std::optional<PosedFusion::Declared> fused;
    if (waiting_) fused = declare_waiting(graph);
    const InputPictures pictures = tracking_.pictures().add(graph, frame.depth, frame.color);
    const TrackingReport report = search(std::move(graph), pictures, frame, start);
    if (fused) {
        fusion_.note(*fused);
        waiting_.reset();
    }
    return report;
}

/// With the pictures of the frame's first search.
TrackingReport TrackedFusion::search_again(const RgbdFrame& frame, const RigidTransform& start) {
    graph::FrameGraph graph = runner_.begin();
    const InputPictures pictures = tracking_.pictures().import(graph);
    return search(std::move(graph), pictures, frame, start);
}

TrackingReport TrackedFusion::search(graph::FrameGraph graph, const InputPictures& pictures, const RgbdFrame& frame,
                                     const RigidTransform& start) {
    const TrackColor color{pictures.color, frame.color.camera, frame.color_from_depth};
    const auto pyramid = tracking_.add_pyramid(graph, pictures.depth_m, frame.depth.camera,
                                               stages_.track_shades() ? std::optional(color) : std::nullopt,
                                               stages_.settings.fusion.max_depth_m);
    const TrackingStage::Search search = tracking_.add_search(graph, pyramid, start);
    runner_.submit(std::move(graph));
    runner_.wait();
    return tracking_.report_of(search);
}

std::optional<TrackingReport> TrackedFusion::relocalised(const RgbdFrame& frame) {
    const RigidTransform before = tracking_.world_from_reference();
    const std::vector<RigidTransform> starts = candidates(frame);
    for (const RigidTransform& start : starts) {
        TrackingReport report = search_from(frame, start);
        // From afar it may not have settled, or the view from the start showed too little of what the frame does.
        if (report.state == TrackingState::kWeak) report = search_from(frame, report.world_from_depth);
        if (report.state == TrackingState::kTracking && report.share >= tracking_.settings().bounds.jump_share)
            return report;
    }
    if (!starts.empty()) cast_reference(frame.depth.camera, before);
    return std::nullopt;
}

std::vector<RigidTransform> TrackedFusion::candidates(const RgbdFrame& frame) {
    if (relocaliser_) return relocaliser_(frame);
    std::vector<RigidTransform> poses;
    if (!stages_.keyframes || fusion_.frames() == 0) return poses;
    graph::FrameGraph graph = runner_.begin();
    const graph::Readback lookup = stages_.keyframes->add_lookup(graph, tracking_.pictures().import(graph));
    runner_.submit(std::move(graph));
    runner_.wait();
    for (const KeyframePose& pose : KeyframeStage::candidates_of(lookup)) poses.push_back(pose.world_from_depth);
    return poses;
}

TrackingReport TrackedFusion::search_from(const RgbdFrame& frame, const RigidTransform& start) {
    cast_reference(frame.depth.camera, start);
    return search_again(frame, start);
}

void TrackedFusion::cast_reference(const Intrinsics& camera, const RigidTransform& world_from_depth) {
    const PosedCamera posed = make_posed_camera(camera, world_from_depth);
    fusion_.require(camera, world_from_depth);
    graph::FrameGraph graph = runner_.begin();
    const VoxelMapIds voxels = stages_.geometry.map().import(graph);
    const VisibleBlocks visible = stages_.geometry.add_visible(graph, voxels, posed);
    wire_reference(graph, stages_, voxels, visible, stages_.geometry.add_raycast(graph, voxels, visible), posed);
    runner_.submit(std::move(graph));
}

}  // namespace patina
