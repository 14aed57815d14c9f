#include "tools/bench/random_network.h"

#include <cmath>
#include <random>

namespace patina {

NetworkDescription with_random_weights(NetworkDescription network, uint32_t seed) {
    std::mt19937 random(seed);
    const auto uniform = [&](float most) {
        return most * (static_cast<float>(random() >> 8) / static_cast<float>(1u << 23) - 1);
    };
    ActivationShape shape{network.samples, network.side, network.channels};
    for (NetworkLayer& layer : network.layers) {
        const bool convolution = layer.kind == LayerKind::kConv;
        if (convolution || layer.kind == LayerKind::kFull) {
            const uint32_t fan_in = shape.channels * (convolution ? 9 : 1);
            layer.weight.resize(size_t{layer.outputs} * fan_in);
            layer.bias.resize(layer.outputs);
            const float most = std::sqrt(6 / static_cast<float>(fan_in));
            for (float& weight : layer.weight) weight = uniform(most);
            for (float& bias : layer.bias) bias = uniform(0.1f);
        }
        shape = shape_after(network, layer, shape);
    }
    return network;
}

NetworkDescription random_hemi_network(uint32_t seed) {
    NetworkDescription network;
    network.layers = {{LayerKind::kConv, "conv1", 16, 1, true}, {LayerKind::kConv, "conv2", 32, 1, true},
                      {LayerKind::kMaxPool, "pool2"},           {LayerKind::kConv, "conv3", 48, 1, true},
                      {LayerKind::kMaxPool, "pool3"},           {LayerKind::kConv, "conv4", 64, 0, true},
                      {LayerKind::kSamplePool, "pool"},         {LayerKind::kFull, "full1", 128, 0, true},
                      {LayerKind::kFull, "full2", 64, 0, true}, {LayerKind::kFull, "full3", 7}};
    return with_random_weights(std::move(network), seed);
}

}  // namespace patina
