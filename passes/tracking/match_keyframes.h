#pragma once

#include "passes/state/keyframe_store.h"

namespace patina {

/// What of two frames is compared.
enum class KeyframeTests : uint8_t {
    kAll,   ///< colour and depth
    kDepth  ///< depth alone: for frames of another exposure than the keyframes'
};

struct KeyframeMatches {
    graph::BufferId dissimilarities;  ///< float per slot of the store, undefined from the count of keyframes on
    graph::BufferId matches;          ///< gpu::KeyframeMatch[count], least dissimilar first, of equals the older one
};

/// Compares a frame's code (add_encode_frame) with all keyframes: the dissimilarity is the share of ferns that differ
/// in some test, among those whose depth both frames know; 1 where that are less than a quarter of all. Tests of colour
/// count where both frames know the fern's colour, so that a frame without colours is compared by depth alone. Returns
/// the `count` least dissimilar ones; slots are gpu::kNoKeyframe where the store has fewer. Throws Error unless count
/// is 1 to gpu::kMostMatches.
KeyframeMatches add_match_keyframes(graph::FrameGraph& frame, const KeyframeStore& store, const KeyframeStoreIds& ids,
                                    graph::BufferId code, uint32_t count, KeyframeTests tests = KeyframeTests::kAll);

}  // namespace patina
