#include "passes/keyframe_model.h"

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

KeyframeModel::KeyframeModel(vulkan::Device& device, const KeyframeSettings& settings)
    : settings_(checked(settings)), store_(device, settings.store) {}

graph::BufferId KeyframeModel::add_encode(graph::Frame& frame, graph::ImageId depth_m,
                                          graph::ImageId color_linear) const {
    return add_encode_frame(frame, add_shrink_frame(frame, depth_m, color_linear), store_.import(frame).ferns);
}

void KeyframeModel::add_keep(graph::Frame& frame, graph::ImageId depth_m, graph::ImageId color_linear,
                             const RigidTransform& world_from_depth, uint32_t number) const {
    KeyframeStoreIds ids = store_.import(frame);
    const graph::BufferId code = add_encode(frame, depth_m, color_linear);
    const KeyframeMatches nearest = add_match_keyframes(frame, store_, ids, code, 1, settings_.tests);
    const gpu::KeyframeCandidate candidate{glm::mat4(world_from_depth), number, 1, 0, 0};
    const auto id = frame.upload<gpu::KeyframeCandidate>("keyframes.candidate", std::span(&candidate, 1));
    add_keep_keyframe(frame, store_, ids, code, nearest, id);
    KeyframeStore::keep(frame, ids);
}

graph::Readback KeyframeModel::add_lookup(graph::Frame& frame, graph::ImageId depth_m,
                                          graph::ImageId color_linear) const {
    const graph::BufferId code = add_encode(frame, depth_m, color_linear);
    return frame.read_back(
        add_match_keyframes(frame, store_, store_.import(frame), code, settings_.candidates, settings_.tests).matches);
}

std::vector<KeyframePose> KeyframeModel::candidates_of(const graph::Readback& lookup) {
    std::vector<KeyframePose> poses;
    for (const gpu::KeyframeMatch& match : lookup.as<gpu::KeyframeMatch>()) {
        if (match.slot == gpu::kNoKeyframe || match.dissimilarity >= 1) continue;
        // The device holds it in single precision.
        poses.push_back({orthonormalised(RigidTransform(match.world_from_camera)), match.dissimilarity, match.frame});
    }
    return poses;
}

graph::Readback KeyframeModel::read_counters(graph::Frame& frame) const {
    return frame.read_back(store_.import(frame).counters);
}

}  // namespace patina
