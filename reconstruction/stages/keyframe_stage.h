#pragma once

#include <vector>

#include "passes/input/input.h"
#include "passes/state/keyframe_store.h"
#include "passes/tracking/match_keyframes.h"
#include "reconstruction/frame_context.h"

namespace patina {

/// How keyframes are chosen and looked up.
struct KeyframeSettings {
    KeyframeStoreSettings store;
    /// What is compared. Colours tell more places apart, but not where the camera changes its exposure by itself.
    KeyframeTests tests = KeyframeTests::kAll;
    uint32_t candidates = 5;  ///< poses at which a lost camera is looked for; at most gpu::kMostMatches
};

/// A pose at which the camera may be.
struct KeyframePose {
    RigidTransform world_from_depth{1.0};
    float dissimilarity = 0;  ///< of the keyframe and the frame; 0 to 1
    uint32_t frame = 0;       ///< the keyframe's number, FrameContext::index
};

/// Keyframes of a map, and where a frame that looks like them may have been taken. Lives as long as the map. Depths may
/// be smoothed or not.
class KeyframeStage {
  public:
    /// Throws Error as KeyframeStore does, and when candidates are none or too many.
    KeyframeStage(vulkan::Device& device, const KeyframeSettings& settings);

    /// Forgets all keyframes; the first thing done with it.
    void reset(graph::FrameGraph& graph) const { store_.reset(graph); }

    /// Keeps a frame that was tracked well if it is unlike all keyframes so far, or near none of them.
    void add_keep(graph::FrameGraph& graph, const InputPictures& pictures, const FrameContext& frame) const;

    /// Looks a frame up whose camera is lost; candidates_of() tells the result once the graph has finished.
    graph::Readback add_lookup(graph::FrameGraph& graph, const InputPictures& pictures) const;

    /// Where the frame of a lookup may have been taken, most similar keyframe first; those that have nothing in common
    /// with it (dissimilarity 1) are left out.
    static std::vector<KeyframePose> candidates_of(const graph::Readback& lookup);

    /// gpu::KeyframeCounters as of the end of this graph.
    graph::Readback read_counters(graph::FrameGraph& graph) const;

    void visit(graph::StateVisitor& visitor) { store_.visit(visitor); }

    const KeyframeSettings& settings() const { return settings_; }
    const KeyframeStore& store() const { return store_; }

  private:
    graph::BufferId add_encode(graph::FrameGraph& graph, const InputPictures& pictures) const;

    KeyframeSettings settings_;
    KeyframeStore store_;
};

}  // namespace patina
