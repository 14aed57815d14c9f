#include "passes/state/keyframe_store.h"

#include <random>

#include "engine/core/error.h"

namespace patina {

namespace {

const KeyframeStoreSettings& checked(const KeyframeStoreSettings& settings) {
    if (settings.capacity == 0 || settings.capacity > KeyframeStore::kMaxCapacity) {
        throw Error("the keyframe store's capacity is ", settings.capacity, " keyframes, it must be 1 to ",
                    KeyframeStore::kMaxCapacity);
    }
    if (!(settings.least_depth_m > 0 && settings.most_depth_m > settings.least_depth_m)) {
        throw Error("keyframes' thresholds of depth lie from ", settings.least_depth_m, " m to ", settings.most_depth_m,
                    " m, which is no range");
    }
    if (!(settings.least_dissimilarity >= 0 && settings.least_dissimilarity <= 1)) {
        throw Error("keyframes' least_dissimilarity is ", settings.least_dissimilarity, ", it must be 0 to 1");
    }
    if (!(settings.near_m >= 0 && settings.near_degrees >= 0 && settings.near_degrees <= 180)) {
        throw Error("keyframes are near within ", settings.near_m, " m and ", settings.near_degrees,
                    " degrees, which must be at least 0, and at most 180 degrees");
    }
    return settings;
}

}  // namespace

std::vector<gpu::Fern> make_ferns(const KeyframeStoreSettings& settings) {
    std::mt19937 words(settings.seed);
    // Exact on every platform, unlike std::uniform_real_distribution.
    const auto fraction = [&] { return static_cast<double>(words()) / 4294967296.0; };
    std::vector<gpu::Fern> ferns(gpu::kFerns);
    for (gpu::Fern& fern : ferns) {
        fern.pixel.x = static_cast<uint32_t>(gpu::kSmallWidth * fraction());
        fern.pixel.y = static_cast<uint32_t>(gpu::kSmallHeight * fraction());
        for (glm::length_t c = 0; c < 3; ++c) fern.color[c] = static_cast<float>(0.1 + 0.8 * fraction());
        fern.color.w = 0;
        fern.depth_m =
            static_cast<float>(settings.least_depth_m + (settings.most_depth_m - settings.least_depth_m) * fraction());
        fern.pad0 = 0;
    }
    return ferns;
}

KeyframeStore::KeyframeStore(vulkan::Device& device, const KeyframeStoreSettings& settings)
    : settings_(checked(settings)) {
    const auto buffer = [&](const char* name, uint64_t bytes) { return device.create_buffer({name, bytes}); };
    ferns_ = buffer("keyframes.ferns", gpu::kFerns * sizeof(gpu::Fern));
    codes_ = buffer("keyframes.codes", uint64_t{settings.capacity} * gpu::kFernWords * sizeof(uint32_t));
    keyframes_ = buffer("keyframes.keyframes", settings.capacity * sizeof(gpu::Keyframe));
    counters_ = buffer("keyframes.counters", sizeof(gpu::KeyframeCounters));
}

void KeyframeStore::reset(graph::FrameGraph& frame) const {
    const std::vector<gpu::Fern> ferns = make_ferns(settings_);
    KeyframeStoreIds ids = import(frame);
    ids.ferns = frame.upload_bytes(ids.ferns, 0, std::as_bytes(std::span(ferns)), true);
    ids.codes = frame.fill(ids.codes, 0);
    ids.keyframes = frame.fill(ids.keyframes, 0);
    ids.counters = frame.fill(ids.counters, 0);
    frame.keep(ids.ferns);
    keep(frame, ids);
}

KeyframeStoreIds KeyframeStore::import(graph::FrameGraph& frame) const {
    return {frame.import(ferns_), frame.import(codes_), frame.import(keyframes_), frame.import(counters_)};
}

void KeyframeStore::keep(graph::FrameGraph& frame, const KeyframeStoreIds& ids) {
    for (const graph::BufferId id : {ids.codes, ids.keyframes, ids.counters}) frame.keep(id);
}

uint64_t KeyframeStore::bytes() const {
    return ferns_->bytes() + codes_->bytes() + keyframes_->bytes() + counters_->bytes();
}

void KeyframeStore::visit(graph::StateVisitor& visitor) {
    for (vulkan::BufferRef* buffer : {&ferns_, &codes_, &keyframes_, &counters_}) visitor.buffer(*buffer);
}

}  // namespace patina
