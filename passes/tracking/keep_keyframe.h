#pragma once

#include "passes/model/keyframe_store.h"
#include "passes/tracking/match_keyframes.h"

namespace patina {

/// Stores a frame as a keyframe if `candidate` (gpu::KeyframeCandidate) says that it was tracked well, its least
/// dissimilar keyframe, matches[0] over all tests, is farther than the store's least_dissimilarity or there is none,
/// and half of its ferns know the depth. When the store is full the frame is counted as refused instead;
/// keyframes that are there stay. Replaces the store's ids.
void add_keep_keyframe(graph::Frame& frame, const KeyframeStore& store, KeyframeStoreIds& ids, graph::BufferId code,
                       const KeyframeMatches& matches, graph::BufferId candidate);

}  // namespace patina
