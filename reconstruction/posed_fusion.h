#pragma once

#include <deque>

#include "engine/graph/runner.h"
#include "passes/input/input.h"
#include "reconstruction/frame_context.h"
#include "reconstruction/frame_graph.h"
#include "reconstruction/growing_pools.h"
#include "reconstruction/pipeline_counters.h"
#include "reconstruction/stages/stages.h"
#include "reconstruction/streaming/streaming.h"

namespace patina {

/// Fuses frames whose pose is known, one graph each, two of them in flight. Before a graph the pools grow where they
/// are short; after it the frame's counters are gathered as they arrive.
class PosedFusion {
  public:
    /// All must outlive this.
    PosedFusion(graph::Runner& runner, Stages& stages, Streaming& streaming);

    /// Fuses a frame in a graph of its own. The first one places the map around its camera. Throws Error when the
    /// device was lost or lacks memory.
    void add(const RgbdFrame& frame);

    /// A frame of low exposure, before the first one: what it tells of geometry, of segments, and of which are mirrors.
    /// `radiance_scale`: the others' exposure over its own.
    void add_preceding(const RgbdFrame& frame, float radiance_scale);
    /// There are no more of them: what was observed at low exposure is forgotten.
    void end_preceding();

    /// A frame whose passes are declared.
    struct Declared {
        FrameContext frame;
        FrameReadbacks counters;
    };
    /// The steps of add(), for a graph that does more than fuse a frame; not for the first one. begin() starts a graph,
    /// declare() adds the frame's passes to it, note() counts the frame once the graph was submitted.
    graph::FrameGraph begin(const RgbdFrame& frame);
    Declared declare(graph::FrameGraph& graph, const RgbdFrame& frame, const InputPictures& pictures);
    void note(const Declared& declared);

    /// Brings back what a camera sees of the model, as far as the pool holds it; before a graph that looks at it
    /// besides frames.
    void require(const Intrinsics& camera, const RigidTransform& world_from_camera);

    uint32_t frames() const { return history_.frames - history_.preceding; }  ///< fused so far

    /// The device must have finished.
    void visit(graph::StateVisitor& visitor);

    /// Of the frames that the device has finished; without tracking.
    PipelineCounters counters();

  private:
    void add_first(const RgbdFrame& frame);
    Declared submit(graph::FrameGraph graph, const RgbdFrame& frame);
    void start_map(const RgbdFrame& frame);
    void count(const Declared& declared);
    void take_counters();

    graph::Runner& runner_;
    Stages& stages_;
    Streaming& streaming_;
    GrowingPools pools_;
    FrameHistory history_;
    glm::dvec3 center_m_{0};              ///< of the map
    float radiance_scale_ = 0;            ///< of frames that precede the first one; 0: none do at present
    std::deque<FrameReadbacks> pending_;  ///< of frames that the device may work on
    PipelineCounters counted_;            ///< but for pools
};

}  // namespace patina
