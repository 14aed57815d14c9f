#include "passes/tracking/keep_keyframe.h"

#include <cmath>

#include "spirv/shaders.h"

namespace patina {

void add_keep_keyframe(graph::FrameGraph& frame, const KeyframeStore& store, KeyframeStoreIds& ids,
                       graph::BufferId code, const KeyframeMatches& matches, graph::BufferId candidate) {
    auto pass = frame.compute("tracking.keep_keyframe", spirv::keep_keyframe);
    pass.read("Code", code).read("Candidate", candidate).read("Matches", matches.matches);
    const KeyframeStoreSettings& settings = store.settings();
    pass.push(gpu::KeepKeyframeParams{settings.capacity, settings.least_dissimilarity, gpu::kFerns / 4, settings.near_m,
                                      std::cos(glm::radians(settings.near_degrees))});
    ids.codes = pass.modify("Codes", ids.codes);
    ids.keyframes = pass.modify("Keyframes", ids.keyframes);
    ids.counters = pass.modify("Counters", ids.counters);
    pass.dispatch(1);
}

}  // namespace patina
