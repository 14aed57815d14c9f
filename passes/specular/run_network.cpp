#include "passes/specular/run_network.h"

#include <algorithm>

#include "engine/core/divided_up.h"
#include "engine/core/error.h"
#include "shared/specular/network.h"
#include "spirv/shaders.h"

namespace patina {

namespace {

/// The pixels that an invocation of a convolution computes a quad of channels of.
struct Tile {
    uint32_t width = 1;
    uint32_t height = 1;
    uint32_t images = 1;
    uint32_t per_row = 1;  ///< as many side by side
    uint32_t rows = 1;
};

/// One dispatch: a layer, or a convolution with the pooling that follows it.
struct Step {
    LayerKind kind = LayerKind::kConv;
    bool max_pooled = false;  ///< a convolution
    Tile tile{};
    uint32_t quad_inputs = 4;  ///< that are used of each quad
    gpu::LayerParams params{};
    gpu::BatchWork work{};
    uint64_t output_quads = 0;  ///< per segment
};

// Measured on lavapipe: fewer pixels load each weight more often; more gain nothing, as their code outgrows the caches.
constexpr uint32_t kWidestTile = 16, kMostTilePixels = 32, kMostImagesPerTile = 8;
constexpr uint32_t kLeastTilePixels = 4;  // 2 x 2, which pooling needs
// Of GPUs, whose cores wait for memory unless each has several threads: enough for some 4000 cores. Not measured.
constexpr uint32_t kBusyInvocations = 32768;

/// The tiles of a square of `side` pixels, each of at most `pixels`.
Tile tile_for(uint32_t side, bool max_pooled, uint32_t pixels) {
    const uint32_t height = max_pooled ? 2 : 1, widest = std::min(pixels / height / height * height, kWidestTile);
    const uint32_t least = divided_up(side, divided_up(side, widest)), width = divided_up(least, height) * height;
    const uint32_t images = std::clamp(pixels / (width * height), 1u, kMostImagesPerTile);
    return {width, height, images, divided_up(side, width), divided_up(side, height)};
}

uint64_t quads_in_segment(const ActivationShape& shape) {
    return uint64_t{shape.images} * shape.side * shape.side * quads_of(shape);
}

/// The pixels of a tile, of so many pixels of quads in a whole batch.
uint32_t tile_pixels(uint64_t quad_pixels, uint32_t least_invocations) {
    if (least_invocations == 0) return kMostTilePixels;
    return static_cast<uint32_t>(
        std::clamp<uint64_t>(quad_pixels / least_invocations, kLeastTilePixels, kMostTilePixels));
}

/// Layers `first` to `last` of a network in one dispatch.
Step make_step(const Network& network, size_t first, size_t last, uint32_t capacity, uint32_t least_invocations) {
    const ActivationShape &before = network.shapes()[first], &after = network.shapes()[last + 1];
    const NetworkLayer& layer = network.description().layers[first];
    Step step{layer.kind, last > first};
    const Network::Place place = network.place(first);
    gpu::LayerParams& params = step.params;
    params = {before.images, before.side,  after.side,           layer.pad, quads_of(before), quads_of(after),
              place.weights, place.biases, layer.relu ? 1u : 0u, capacity};
    step.output_quads = quads_in_segment(after);
    step.work = {before.images, 1, after.side * after.side * params.output_quads, 1};
    if (layer.kind == LayerKind::kSamplePool) step.work = {1, 1, params.input_quads, 1};
    if (layer.kind != LayerKind::kConv) return step;
    const uint32_t computed = step.max_pooled ? 2 * after.side : after.side;
    step.quad_inputs = std::min(before.channels, 4u);
    const uint64_t quad_pixels = uint64_t{capacity} * after.images * computed * computed * params.output_quads;
    step.tile = tile_for(computed, step.max_pooled, tile_pixels(quad_pixels, least_invocations));
    step.work = {before.images, step.tile.images, step.tile.per_row * step.tile.rows * params.output_quads, 1};
    return step;
}

std::vector<Step> plan(const Network& network, uint32_t capacity, uint32_t least_invocations) {
    const std::vector<NetworkLayer>& layers = network.description().layers;
    std::vector<Step> steps;
    for (size_t i = 0; i < layers.size(); ++i) {
        const bool pooled =
            layers[i].kind == LayerKind::kConv && i + 1 < layers.size() && layers[i + 1].kind == LayerKind::kMaxPool;
        steps.push_back(make_step(network, i, i + pooled, capacity, least_invocations));
        i += pooled;
    }
    return steps;
}

void check_images(const Network& network, uint32_t capacity, uint64_t bytes) {
    const uint64_t needed = uint64_t{capacity} * quads_in_segment(network.shapes().front()) * 16;
    if (bytes >= needed) return;
    throw Error("the pass 'specular.run_network' has images of ", bytes, " bytes, a batch of ", capacity,
                " segments takes ", needed);
}

/// Of weights and activations, quads.
uint64_t largest_buffer(const Network& network, uint32_t capacity) {
    uint64_t largest = network.weight_quads();
    for (const ActivationShape& shape : network.shapes())
        largest = std::max(largest, capacity * quads_in_segment(shape));
    return largest;
}

/// One shader of each kind of layer.
struct LayerShaders {
    const vulkan::Shader &conv, &max_pool, &sample_pool, &full;

    const vulkan::Shader& of(LayerKind kind) const {
        switch (kind) {
            case LayerKind::kConv: return conv;
            case LayerKind::kMaxPool: return max_pool;
            case LayerKind::kSamplePool: return sample_pool;
            case LayerKind::kFull: break;
        }
        return full;
    }
};

LayerShaders shaders_of(NetworkFormat format) {
    using namespace spirv;
    switch (format) {
        case NetworkFormat::kFloats: break;
        case NetworkFormat::kTexels: return {convolve_texel, max_pool, pool_samples, connect_texel};
        case NetworkFormat::kHalves: return {convolve_half, max_pool_half, pool_samples_half, connect_half};
    }
    return {convolve, max_pool, pool_samples, connect};
}

}  // namespace

NetworkVariant preferred_network_variant(const vulkan::DeviceCaps& caps, const Network& network, uint32_t capacity) {
    if (!caps.software()) {
        const bool halves = caps.float16 && network.fits_halves();
        return {halves ? NetworkFormat::kHalves : NetworkFormat::kFloats, kBusyInvocations};
    }
    const bool texels = largest_buffer(network, capacity) <= caps.max_texel_elements;
    return {texels ? NetworkFormat::kTexels : NetworkFormat::kFloats, 0};
}

NetworkVariant network_variant(const vulkan::DeviceCaps& caps, const Network& network, uint32_t capacity,
                               NetworkFormat format) {
    const std::string& source = network.description().source;
    if (format == NetworkFormat::kHalves && !caps.float16) {
        throw Error("the device '", caps.name, "' has no 16-bit floats to run ", source, " in");
    }
    if (format == NetworkFormat::kHalves && !network.fits_halves()) {
        throw Error(source, " has weights that 16-bit floats cannot hold");
    }
    const uint64_t largest = largest_buffer(network, capacity);
    if (format == NetworkFormat::kTexels && largest > caps.max_texel_elements) {
        throw Error("the device '", caps.name, "' has texel buffers of at most ", caps.max_texel_elements,
                    " elements, to run ", source, " takes ", largest);
    }
    NetworkVariant variant = preferred_network_variant(caps, network, capacity);
    variant.format = format;
    return variant;
}

graph::BufferId add_run_network(graph::FrameGraph& frame, Network& network, graph::BufferId images,
                                const SegmentBatch& batch, const NetworkVariant& variant) {
    const std::vector<Step> steps = plan(network, batch.capacity, variant.least_invocations);
    check_images(network, batch.capacity, frame.bytes(images));
    if (steps.empty()) return images;
    std::vector<gpu::BatchWork> work;
    for (const Step& step : steps) work.push_back(step.work);
    const graph::BufferId arguments = add_plan_batch(frame, batch, work);

    const bool halves = variant.format == NetworkFormat::kHalves;
    const LayerShaders shaders = shaders_of(variant.format);
    const graph::BufferId weights = network.import(frame, halves);
    graph::BufferId activations = images;
    for (size_t i = 0; i < steps.size(); ++i) {
        const Step& step = steps[i];
        const vulkan::Shader& shader = shaders.of(step.kind);
        const bool last = i + 1 == steps.size();
        auto pass = frame.compute(text(shader.name, "_", i + 1), shader);
        pass.read("Batch", batch.list).read("Inputs", activations).push(step.params);
        if (shader.find_binding("Weights")) pass.read("Weights", weights);
        if (step.kind == LayerKind::kConv) {
            pass.specialise("kTileWidth", step.tile.width).specialise("kTileHeight", step.tile.height);
            pass.specialise("kTileImages", step.tile.images).specialise("kPooled", step.max_pooled);
            pass.specialise("kTilesPerRow", step.tile.per_row).specialise("kTileRows", step.tile.rows);
            pass.specialise("kOutputQuads", step.params.output_quads);
            pass.specialise("kQuadInputs", step.quad_inputs);
        }
        if (halves) pass.specialise("kWideInputs", i == 0).specialise("kWideOutputs", last);
        activations = pass.create("Outputs", batch.capacity * step.output_quads * (halves && !last ? 8 : 16));
        pass.dispatch_indirect(arguments, i * sizeof(glm::uvec4));
    }
    return activations;
}

}  // namespace patina
