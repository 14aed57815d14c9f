#include "reconstruction/posed_fusion.h"

#include <array>

#include "passes/input/convert_color.h"
#include "passes/input/convert_depth.h"
#include "passes/photometry/estimate_gains.h"

namespace patina {

namespace {

ResidentPlaces resident_of(const ReconstructionSettings& settings) {
    return {settings.resident_blocks, settings.reflectance ? settings.reflectance->resident_records : 0};
}

}  // namespace

PosedFusion::PosedFusion(graph::Runner& runner, Stages& stages, Streaming& streaming)
    : runner_(runner),
      stages_(stages),
      streaming_(streaming),
      pools_(runner.device(), stages.geometry.map(), pointer_to(stages.segmentation), pointer_to(stages.reflectance),
             pointer_to(stages.specular), resident_of(stages.settings)) {}

void PosedFusion::add(const RgbdFrame& frame) {
    if (history_.frames == 0) return add_first(frame);
    note(submit(begin(frame), frame));
}

void PosedFusion::add_preceding(const RgbdFrame& frame, float radiance_scale) {
    radiance_scale_ = radiance_scale;
    add(frame);
}

void PosedFusion::end_preceding() {
    if (radiance_scale_ == 0) return;
    radiance_scale_ = 0;
    history_.world_from_color.reset();
    graph::FrameGraph graph = runner_.begin();
    stages_.forget_observations(graph, center_m_, history_.frames);
    runner_.submit(std::move(graph));
    streaming_.forget_records();
}

/// Nothing is known yet of what the first frame asks for. Where that is more than the pools hold, they grow, and the
/// frame is fused anew, into an empty model.
void PosedFusion::add_first(const RgbdFrame& frame) {
    Declared declared;
    do {
        start_map(frame);
        declared = submit(runner_.begin(), frame);
        pools_.await(0, declared.counters.pools);
        runner_.wait();
    } while (pools_.first_was_refused() && pools_.grow(runner_, 0));
    count(declared);
}

void PosedFusion::start_map(const RgbdFrame& frame) {
    graph::FrameGraph graph = runner_.begin();
    center_m_ = glm::dvec3(frame.world_from_depth[3]);
    stages_.reset(graph, center_m_);
    runner_.submit(std::move(graph));
    pools_.reset();
    streaming_.reset();
}

PosedFusion::Declared PosedFusion::submit(graph::FrameGraph graph, const RgbdFrame& frame) {
    InputPictures pictures{add_convert_depth(graph, frame.depth), add_convert_color(graph, frame.color)};
    if (radiance_scale_ > 0) {
        const std::array gains{gpu::ColorGains{glm::vec4(1 / radiance_scale_), glm::uvec4(0)}};
        pictures.color =
            add_apply_gains(graph, pictures.color, graph.upload<gpu::ColorGains>("frames.relative_exposure", gains));
    }
    Declared declared = declare(graph, frame, pictures);
    runner_.submit(std::move(graph));
    return declared;
}

graph::FrameGraph PosedFusion::begin(const RgbdFrame& frame) {
    runner_.begin();  // waits for the frame before the last
    const uint32_t index = history_.frames;
    const FrameCameras cameras = make_frame_cameras(frame);
    const StreamRegion around = stages_.geometry.around(cameras.depth, cameras.color);
    const Streaming::Many many{pools_.has_many_blocks(index), stages_.reflectance && pools_.has_many_records(index)};
    pools_.grow(runner_, index, streaming_.plan(around, index, many));
    streaming_.move_surplus();
    return runner_.begin();
}

void PosedFusion::require(const Intrinsics& camera, const RigidTransform& world_from_camera) {
    const StreamRegion seen = stages_.geometry.around_view(make_posed_camera(camera, world_from_camera));
    streaming_.require_blocks(seen);
    streaming_.require_records(seen);
}

PosedFusion::Declared PosedFusion::declare(graph::FrameGraph& graph, const RgbdFrame& frame,
                                           const InputPictures& pictures) {
    Declared declared;
    declared.frame =
        make_frame_context(frame, history_, stages_.geometry.range(frame.depth.camera), stages_.settings.fusion.color);
    declared.frame.around = stages_.geometry.around(declared.frame.depth, declared.frame.color);
    declared.frame.precedes = radiance_scale_ > 0;
    if (declared.frame.precedes) declared.frame.fuses_color = false;
    declared.frame.shadows_m = stages_.settings.around_m;
    streaming_.add(graph);
    declared.frame.labels_away = streaming_.labels_away(declared.frame.index);
    declared.counters = wire_frame(graph, stages_, declared.frame, pictures);
    streaming_.await_sweep(graph, declared.frame.index);
    return declared;
}

void PosedFusion::note(const Declared& declared) {
    pools_.await(declared.frame.index, declared.counters.pools);
    count(declared);
}

void PosedFusion::count(const Declared& declared) {
    streaming_.note_submitted();
    if (!declared.frame.precedes) pending_.push_back(declared.counters);
    history_.note(declared.frame);
    take_counters();
}

void PosedFusion::take_counters() {
    for (; !pending_.empty() && pending_.front().visible_blocks.ready(); pending_.pop_front()) {
        const FrameReadbacks& read = pending_.front();
        counted_.map = read.pools.voxels.as<gpu::MapCounters>().front();
        counted_.visible_blocks = read.visible_blocks.as<uint32_t>().front();
        if (stages_.segmentation) {
            counted_.segments = read.pools.labels.as<gpu::SegmentCounters>().front();
            counted_.label_stability.add(counted_.segments);
        }
        if (!stages_.reflectance) continue;
        counted_.observations.blocks = read.pools.observed_blocks.as<gpu::MapCounters>().front();
        counted_.observations.records = read.pools.observed_records.as<gpu::MapCounters>().front();
    }
}

void PosedFusion::visit(graph::StateVisitor& visitor) {
    take_counters();  // all are there
    pools_.visit(visitor);
    visitor.value("frames.history", history_);
    visitor.value("frames.map_counters", counted_.map);
    visitor.value("frames.visible_blocks", counted_.visible_blocks);
    visitor.value("frames.observation_counters", counted_.observations);
    visitor.value("frames.segment_counters", counted_.segments);
    visitor.value("frames.label_stability", counted_.label_stability);
}

PipelineCounters PosedFusion::counters() {
    take_counters();
    PipelineCounters counters = counted_;
    counters.frames = frames();
    counters.pools = pools_.states();
    return counters;
}

}  // namespace patina
