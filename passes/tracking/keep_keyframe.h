#pragma once

#include "passes/state/keyframe_store.h"
#include "passes/tracking/match_keyframes.h"

namespace patina {

/// Stores a frame as a keyframe if `candidate` (gpu::KeyframeCandidate) says that it was tracked well, half of its
/// ferns know the depth, and either its least dissimilar keyframe, matches[0], is farther than the store's
/// least_dissimilarity, or no keyframe was taken from nearby (near_m, near_degrees). When the store is full the frame
/// is counted as refused instead; keyframes that are there stay. Replaces the store's ids.
void add_keep_keyframe(graph::FrameGraph& frame, const KeyframeStore& store, KeyframeStoreIds& ids,
                       graph::BufferId code, const KeyframeMatches& matches, graph::BufferId candidate);

}  // namespace patina
