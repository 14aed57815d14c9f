#include "reconstruction/stages/keyframe_stage.h"

#include "engine/core/error.h"
#include "passes/tracking/encode_frame.h"
#include "passes/tracking/keep_keyframe.h"

namespace patina {

namespace {

const KeyframeSettings& checked(const KeyframeSettings& settings) {
    if (settings.candidates == 0 || settings.candidates > gpu::kMostMatches) {
        throw Error("keyframes.candidates is ", settings.candidates, ", it must be 1 to ", gpu::kMostMatches);
    }
    return settings;
}

}  // namespace

KeyframeStage::KeyframeStage(vulkan::Device& device, const KeyframeSettings& settings)
    : settings_(checked(settings)), store_(device, settings.store) {}

graph::BufferId KeyframeStage::add_encode(graph::FrameGraph& graph, const InputPictures& pictures) const {
    return add_encode_frame(graph, add_shrink_frame(graph, pictures.depth_m, pictures.color),
                            store_.import(graph).ferns);
}

void KeyframeStage::add_keep(graph::FrameGraph& graph, const InputPictures& pictures, const FrameContext& frame) const {
    KeyframeStoreIds ids = store_.import(graph);
    const graph::BufferId code = add_encode(graph, pictures);
    const KeyframeMatches nearest = add_match_keyframes(graph, store_, ids, code, 1, settings_.tests);
    const gpu::KeyframeCandidate candidate{glm::mat4(frame.depth.world_from_camera), frame.index, 1, 0, 0};
    const auto id = graph.upload<gpu::KeyframeCandidate>("keyframes.candidate", std::span(&candidate, 1));
    add_keep_keyframe(graph, store_, ids, code, nearest, id);
    KeyframeStore::keep(graph, ids);
}

graph::Readback KeyframeStage::add_lookup(graph::FrameGraph& graph, const InputPictures& pictures) const {
    const graph::BufferId code = add_encode(graph, pictures);
    return graph.read_back(
        add_match_keyframes(graph, store_, store_.import(graph), code, settings_.candidates, settings_.tests).matches);
}

std::vector<KeyframePose> KeyframeStage::candidates_of(const graph::Readback& lookup) {
    std::vector<KeyframePose> poses;
    for (const gpu::KeyframeMatch& match : lookup.as<gpu::KeyframeMatch>()) {
        if (match.slot == gpu::kNoKeyframe || match.dissimilarity >= 1) continue;
        // The device holds it in single precision.
        poses.push_back({orthonormalised(RigidTransform(match.world_from_camera)), match.dissimilarity, match.frame});
    }
    return poses;
}

graph::Readback KeyframeStage::read_counters(graph::FrameGraph& graph) const {
    return graph.read_back(store_.import(graph).counters);
}

}  // namespace patina
