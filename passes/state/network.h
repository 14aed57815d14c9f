#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "engine/graph/frame_graph.h"
#include "engine/vulkan/device.h"

namespace patina {

enum class LayerKind : uint8_t {
    kConv,        ///< 3 x 3, with bias
    kMaxPool,     ///< 2 x 2; an odd last row and column are left out
    kSamplePool,  ///< mean and maximum over a segment's samples: all means, then all maxima
    kFull,        ///< fully connected, with bias
};

/// One layer. Weights and biases of convolutions and fully connected layers only.
struct NetworkLayer {
    LayerKind kind = LayerKind::kConv;
    std::string name{};           ///< for messages
    uint32_t outputs = 0;         ///< channels
    uint32_t pad = 0;             ///< of a convolution: rows and columns of zeros around its input, 0 or 1
    bool relu = false;            ///< after the bias
    std::vector<float> weight{};  ///< [out][in][ky][kx], or [out][in]
    std::vector<float> bias{};    ///< [out]
};

/// How directions become points of a HemiImage's disk.
enum class HemisphereMap : uint8_t {
    kParabolic,   ///< (x, y) / (1 + z), which keeps detail at flat angles
    kOrthogonal,  ///< (x, y), as Kim et al. 2017
};

/// A network over sets of square images: layers on each image, a pool over the set, layers on its result.
struct NetworkDescription {
    std::string source = "the network";  ///< the file it is from, for messages
    HemisphereMap map = HemisphereMap::kParabolic;
    uint32_t samples = 25;  ///< images of a set
    uint32_t side = 15;     ///< of an image, pixels
    uint32_t channels = 3;
    std::vector<NetworkLayer> layers;
};

/// What goes from one layer to the next.
struct ActivationShape {
    uint32_t images = 0;  ///< per segment: the samples, or 1 once they are pooled
    uint32_t side = 0;    ///< pixels
    uint32_t channels = 0;
    uint32_t parts = 1;   ///< of the channels, each of which starts with a quad of its own: means and maxima are 2
    bool pooled = false;  ///< over the samples

    bool operator==(const ActivationShape&) const = default;
};

/// The shape after `layer`. Throws Error, naming the description's source and the layer, where the layer cannot follow.
ActivationShape shape_after(const NetworkDescription& network, const NetworkLayer& layer,
                            const ActivationShape& before);

/// The shapes before the first layer, between two, and after the last one. Throws Error as shape_after(), and where a
/// layer's weights or biases are as many as its shape does not ask for.
std::vector<ActivationShape> activation_shapes(const NetworkDescription& network);

/// A network on the device. Lives as long as the reconstruction; specular/run_network.h runs it.
class Network {
  public:
    /// Throws Error as activation_shapes(). `device` outlives it.
    Network(vulkan::Device& device, NetworkDescription description);

    /// The weights, packed as shared/specular/network.h says, in 32- or 16-bit floats; uploads them the first time.
    /// Throws Error when memory runs out.
    graph::BufferId import(graph::FrameGraph& frame, bool halves);

    /// Where a layer's weights are, in quads.
    struct Place {
        uint32_t weights = 0;
        uint32_t biases = 0;
    };

    const NetworkDescription& description() const { return description_; }
    /// One more than there are layers.
    const std::vector<ActivationShape>& shapes() const { return shapes_; }
    Place place(size_t layer) const { return places_[layer]; }
    /// Quads of four weights or biases.
    uint64_t weight_quads() const { return packed_.size() / 4; }
    /// Whether 16-bit floats hold all weights; larger ones would be infinite.
    bool fits_halves() const;
    /// Of device memory, once the weights were imported.
    uint64_t bytes() const;

  private:
    vulkan::Device* device_;
    NetworkDescription description_;
    std::vector<ActivationShape> shapes_;
    std::vector<Place> places_;
    std::vector<float> packed_;
    vulkan::BufferRef floats_, halves_;  ///< null until they are asked for
};

/// Quads that hold so many channels.
inline uint32_t quads_of(uint32_t channels) { return (channels + 3) / 4; }
/// Quads of one pixel.
inline uint32_t quads_of(const ActivationShape& shape) { return shape.parts * quads_of(shape.channels / shape.parts); }

}  // namespace patina
