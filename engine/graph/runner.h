#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "engine/graph/frame_graph.h"
#include "engine/graph/plan/plan.h"
#include "engine/vulkan/device.h"

namespace patina::graph {

/// GPU times of one pass, or of one stretch of host work, over all frames.
struct Timing {
    std::string name;
    std::vector<float> samples_ms;  ///< in order of submission
};

/// A frame as it was compiled, for dumps and for the checker.
struct CompiledFrame {
    Description description;
    Plan plan;
};

/// Runs frames on a device: compiles those of a new shape, reuses the plan and the transient resources of those seen
/// before, records, submits, times every pass, and brings read-backs home. Up to two frames are in flight; begin()
/// waits for the one before these. The transient resources of all shapes share one memory.
class Runner {
  public:
    explicit Runner(vulkan::Device& device);
    ~Runner();
    Runner(const Runner&) = delete;
    Runner& operator=(const Runner&) = delete;

    /// Starts a frame. Throws Error when the device was lost.
    FrameGraph begin();

    /// Compiles, records and submits. Throws Error for a badly wired frame, on lack of memory, on a lost device.
    void submit(FrameGraph frame);

    /// Waits for everything submitted; afterwards all read-backs are ready.
    void wait();

    vulkan::Device& device() { return device_; }

    /// GPU time of every pass so far, in order of first appearance; complete after wait(). Empty without timestamps.
    const std::vector<Timing>& pass_timings() const;
    /// Host time of submit() per frame, waiting not included.
    const Timing& host_timing() const;
    void clear_timings();

    /// Gives back the memory of transient resources once the frames in flight have finished; shapes are compiled anew.
    /// For when frames will have other sizes from now on.
    void forget_shapes();

    /// How often a frame's shape was new and had to be compiled.
    uint32_t compilations() const;
    /// Bytes of device memory held for transient resources: what the largest shape of frames needs. Frames in flight
    /// may hold a smaller block besides until they have finished.
    uint64_t transient_bytes() const;
    /// The last submitted frame.
    const CompiledFrame& last_frame() const;

    /// Memory visible to the host for this frame; used by Frame.
    Staging stage(uint64_t bytes);

    struct State;

  private:
    friend class FrameGraph;
    vulkan::Device& device_;
    std::unique_ptr<State> state_;
};

}  // namespace patina::graph
