#include "passes/tracking/match_keyframes.h"

#include "engine/core/error.h"
#include "spirv/shaders.h"

namespace patina {

namespace {

constexpr uint32_t kColorTests = gpu::kFernRed | gpu::kFernGreen | gpu::kFernBlue;
constexpr uint32_t kLeastFerns = gpu::kFerns / 4;

}  // namespace

KeyframeMatches add_match_keyframes(graph::FrameGraph& frame, const KeyframeStore& store, const KeyframeStoreIds& ids,
                                    graph::BufferId code, uint32_t count, KeyframeTests tests) {
    if (count == 0 || count > gpu::kMostMatches) {
        throw Error("the pass 'tracking.rank_keyframes' is asked for ", count, " keyframes, it must be 1 to ",
                    gpu::kMostMatches);
    }
    const uint32_t capacity = store.settings().capacity;
    auto compare = frame.compute("tracking.compare_keyframes", spirv::compare_keyframes);
    compare.read("Code", code).read("Codes", ids.codes).read("Counters", ids.counters);
    KeyframeMatches out;
    out.dissimilarities = compare.create("Dissimilarities", capacity * sizeof(float));
    const uint32_t tested = gpu::kFernDepth | (tests == KeyframeTests::kAll ? kColorTests : 0);
    compare.push(gpu::CompareKeyframesParams{tested, kLeastFerns}).dispatch(capacity);

    auto rank = frame.compute("tracking.rank_keyframes", spirv::rank_keyframes);
    rank.read("Dissimilarities", out.dissimilarities).read("Keyframes", ids.keyframes).read("Counters", ids.counters);
    out.matches = rank.create("Matches", count * sizeof(gpu::KeyframeMatch));
    rank.push(gpu::RankKeyframesParams{capacity, count}).dispatch(1);
    return out;
}

}  // namespace patina
