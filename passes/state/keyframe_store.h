#pragma once

#include <cstdint>
#include <vector>

#include "engine/graph/frame_graph.h"
#include "engine/graph/state_visitor.h"
#include "engine/vulkan/device.h"
#include "shared/tracking/keyframes.h"

namespace patina {

struct KeyframeStoreSettings {
    uint32_t capacity = 1024;    ///< keyframes; when it is full, further ones are refused and counted
    uint32_t seed = 1;           ///< of the ferns
    float least_depth_m = 0.5f;  ///< thresholds of depth lie between these
    float most_depth_m = 6;
    /// A frame becomes a keyframe when the share of ferns that differ is above this for every keyframe there is, or
    /// when none of them is near: then one that looks alike would not be near enough for tracking to start from.
    float least_dissimilarity = 0.15f;
    float near_m = 0.25f;
    float near_degrees = 12;
};

/// Versions of the store's buffers within one frame.
struct KeyframeStoreIds {
    graph::BufferId ferns;      ///< gpu::Fern[gpu::kFerns]
    graph::BufferId codes;      ///< u32[gpu::kFernWords] per keyframe
    graph::BufferId keyframes;  ///< gpu::Keyframe each
    graph::BufferId counters;   ///< gpu::KeyframeCounters
};

/// Randomized ferns (Glocker, Shotton, Criminisi, Izadi, Real-Time RGB-D Camera Relocalization via Randomized Ferns for
/// Keyframe Encoding, TVCG 2015): pixels of the small picture, and thresholds for each of their values. Fern i takes
/// the outputs 6 i to 6 i + 5 of std::mt19937(seed), each as a fraction u of 2^32: x = floor(40 u), y = floor(30 u),
/// red, green and blue 0.1 + 0.8 u of the square root of linear values, depth evenly from least_depth_m to
/// most_depth_m.
std::vector<gpu::Fern> make_ferns(const KeyframeStoreSettings& settings);

/// Frames by which a lost camera is found again: their codes and poses, in the order in which they came. Lives as long
/// as the map; passes/tracking fills it.
class KeyframeStore {
  public:
    static constexpr uint32_t kMaxCapacity = 16384;

    /// Throws Error when the capacity is 0 or above kMaxCapacity, the range of depth is empty, least_dissimilarity is
    /// not from 0 to 1, or memory runs out.
    KeyframeStore(vulkan::Device& device, const KeyframeStoreSettings& settings);

    /// Forgets all keyframes; the first thing done with it.
    void reset(graph::FrameGraph& frame) const;

    KeyframeStoreIds import(graph::FrameGraph& frame) const;
    static void keep(graph::FrameGraph& frame, const KeyframeStoreIds& ids);

    void visit(graph::StateVisitor& visitor);

    const KeyframeStoreSettings& settings() const { return settings_; }
    uint64_t bytes() const;

  private:
    KeyframeStoreSettings settings_;
    vulkan::BufferRef ferns_, codes_, keyframes_, counters_;
};

}  // namespace patina
