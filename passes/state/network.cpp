#include "passes/state/network.h"

#include <algorithm>
#include <cmath>

#include <glm/gtc/packing.hpp>

#include "engine/core/error.h"
#include "shared/specular/network.h"

namespace patina {

namespace {

template <class... Parts>
[[noreturn]] void fail(const NetworkDescription& network, const NetworkLayer& layer, const Parts&... parts) {
    throw Error(network.source, ": layer '", layer.name, "' ", text(parts...));
}

bool is_weighted(LayerKind kind) { return kind == LayerKind::kConv || kind == LayerKind::kFull; }

ActivationShape after_convolution(const NetworkDescription& network, const NetworkLayer& layer,
                                  const ActivationShape& before) {
    if (layer.pad > 1) fail(network, layer, "has pad ", layer.pad, ", it can be 0 or 1");
    const uint32_t side = before.side + 2 * layer.pad;
    if (side < gpu::kKernelSide) {
        fail(network, layer, "needs an image of at least ", gpu::kKernelSide, " pixels a side, with padding, and gets ",
             side);
    }
    return {before.images, side - gpu::kKernelSide + 1, layer.outputs};
}

/// Where the channel `input` of a layer's input is stored.
uint32_t slot_of(const ActivationShape& before, uint32_t input) {
    const uint32_t channels = before.channels / before.parts;
    return input / channels * 4 * quads_of(channels) + input % channels;
}

size_t weights_of(const NetworkLayer& layer, const ActivationShape& before) {
    const size_t taps = layer.kind == LayerKind::kConv ? gpu::kKernelSide * gpu::kKernelSide : 1;
    return size_t{layer.outputs} * before.channels * taps;
}

/// Appends the weights and biases of a layer to `packed`.
Network::Place pack(const NetworkLayer& layer, const ActivationShape& before, std::vector<float>& packed) {
    const uint32_t taps = layer.kind == LayerKind::kConv ? gpu::kKernelSide * gpu::kKernelSide : 1;
    const size_t slots = size_t{4} * quads_of(before), row = size_t{4} * quads_of(layer.outputs), first = packed.size();
    packed.resize(first + (taps * slots + 1) * row);
    const size_t biases = first + taps * slots * row;
    for (uint32_t out = 0; out < layer.outputs; ++out) {
        for (uint32_t in = 0; in < before.channels; ++in) {
            for (uint32_t tap = 0; tap < taps; ++tap) {
                packed[first + (tap * slots + slot_of(before, in)) * row + out] =
                    layer.weight[(size_t{out} * before.channels + in) * taps + tap];
            }
        }
        packed[biases + out] = layer.bias[out];
    }
    return {static_cast<uint32_t>(first / 4), static_cast<uint32_t>(biases / 4)};
}

/// In 16-bit floats, two in a word. Of an even number.
std::vector<uint32_t> in_halves(const std::vector<float>& values) {
    std::vector<uint32_t> words(values.size() / 2);
    for (size_t i = 0; i < words.size(); ++i) words[i] = glm::packHalf2x16({values[2 * i], values[2 * i + 1]});
    return words;
}

constexpr float kLargestHalf = 65504;

}  // namespace

ActivationShape shape_after(const NetworkDescription& network, const NetworkLayer& layer,
                            const ActivationShape& before) {
    if (is_weighted(layer.kind) && layer.outputs == 0) fail(network, layer, "has 0 outputs, it needs at least 1");
    const bool on_images = layer.kind != LayerKind::kFull;
    if (on_images == before.pooled) {
        fail(network, layer, "must come ", on_images ? "before" : "after", " the samples are pooled");
    }
    switch (layer.kind) {
        case LayerKind::kConv: return after_convolution(network, layer, before);
        case LayerKind::kMaxPool:
            if (before.side < 2) fail(network, layer, "needs an image of at least 2 pixels a side and gets 1");
            return {before.images, before.side / 2, before.channels};
        case LayerKind::kSamplePool:
            if (before.side != 1) fail(network, layer, "needs images of 1 pixel a side and gets ", before.side);
            return {1, 1, 2 * before.channels, 2, true};
        case LayerKind::kFull: return {1, 1, layer.outputs, 1, true};
    }
    fail(network, layer, "is of kind ", static_cast<int>(layer.kind), ", which there is not");
}

std::vector<ActivationShape> activation_shapes(const NetworkDescription& network) {
    for (const uint32_t size : {network.samples, network.side, network.channels}) {
        if (size == 0) throw Error(network.source, ": samples, side and channels must be at least 1, not 0");
    }
    std::vector<ActivationShape> shapes{{network.samples, network.side, network.channels}};
    for (const NetworkLayer& layer : network.layers) {
        const ActivationShape before = shapes.back();
        shapes.push_back(shape_after(network, layer, before));
        if (!is_weighted(layer.kind)) continue;
        if (layer.weight.size() != weights_of(layer, before)) {
            fail(network, layer, "has ", layer.weight.size(), " weights, its shape asks for ",
                 weights_of(layer, before));
        }
        if (layer.bias.size() != layer.outputs) {
            fail(network, layer, "has ", layer.bias.size(), " biases, its shape asks for ", layer.outputs);
        }
    }
    return shapes;
}

Network::Network(vulkan::Device& device, NetworkDescription description)
    : device_(&device),
      description_(std::move(description)),
      shapes_(activation_shapes(description_)),
      places_(description_.layers.size()) {
    for (size_t i = 0; i < places_.size(); ++i) {
        const NetworkLayer& layer = description_.layers[i];
        if (is_weighted(layer.kind)) places_[i] = pack(layer, shapes_[i], packed_);
    }
}

graph::BufferId Network::import(graph::FrameGraph& frame, bool halves) {
    vulkan::BufferRef& weights = halves ? halves_ : floats_;
    if (weights) return frame.import(weights);
    const std::vector<uint32_t> words = halves ? in_halves(packed_) : std::vector<uint32_t>{};
    const auto bytes = halves ? std::as_bytes(std::span(words)) : std::as_bytes(std::span(packed_));
    const vulkan::BufferRef buffer =
        device_->create_buffer({.name = "network.weights", .bytes = std::max<size_t>(bytes.size(), 16)});
    graph::BufferId id = frame.import(buffer);
    if (!bytes.empty()) {
        id = frame.upload_bytes(id, 0, bytes, true);
        frame.keep(id);
    }
    weights = buffer;
    return id;
}

bool Network::fits_halves() const {
    return std::all_of(packed_.begin(), packed_.end(), [](float weight) { return std::abs(weight) <= kLargestHalf; });
}

uint64_t Network::bytes() const { return (floats_ ? floats_->bytes() : 0) + (halves_ ? halves_->bytes() : 0); }

}  // namespace patina
