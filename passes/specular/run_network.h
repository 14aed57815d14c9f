#pragma once

#include "engine/graph/frame_graph.h"
#include "passes/state/network.h"
#include "passes/state/segment_batch.h"

namespace patina {

/// How activations and weights are stored, and computed with.
enum class NetworkFormat : uint8_t {
    kFloats,  ///< 32-bit floats in storage buffers: every device
    kTexels,  ///< the same, read through texel buffers: faster on software devices, where their size allows
    kHalves,  ///< 16-bit floats, two in a word: half the traffic, and on most GPUs twice the arithmetic
              ///< (DeviceCaps::float16)
};

/// How a network is run. What comes out is the same, but in 16-bit floats: there the trained network's outputs are off
/// by up to 0.002. Images and activations beyond 65504 are taken for that.
struct NetworkVariant {
    NetworkFormat format = NetworkFormat::kFloats;
    /// A convolution has so many invocations at least, if its batch has the pixels: each computes fewer of them where
    /// the batch is small, and loads each weight for fewer. 0: it computes as many as pay.
    uint32_t least_invocations = 0;
};

/// The variant that is fastest for batches of so many segments, within the device's limits; on hardware not measured.
NetworkVariant preferred_network_variant(const vulkan::DeviceCaps& caps, const Network& network, uint32_t capacity);

/// The same in another format. Throws Error where the device lacks it, or it cannot hold the weights.
NetworkVariant network_variant(const vulkan::DeviceCaps& caps, const Network& network, uint32_t capacity,
                               NetworkFormat format);

/// Runs a network on the images of all segments of a batch. `images`: vec4 [segment][sample][y][x], three channels and
/// an unused one for a network of three; quads_of(channels) vec4 a pixel in general. Returns the last layer's
/// activations, vec4 [segment][sample][y][x][quad] as far as they are there, in every format; undefined beyond the
/// segments of the batch. The device has to have the variant's format. Throws Error when `images` or the batch's
/// capacity do not fit, or memory for the weights runs out.
graph::BufferId add_run_network(graph::FrameGraph& frame, Network& network, graph::BufferId images,
                                const SegmentBatch& batch, const NetworkVariant& variant);

}  // namespace patina
