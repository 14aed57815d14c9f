#pragma once

#include <cstdint>

#include "passes/state/network.h"

namespace patina {

/// Gives the layers of a network weights at random (He et al. 2015: activations keep their size from layer to layer)
/// and small biases. The same seed, the same weights.
NetworkDescription with_random_weights(NetworkDescription network, uint32_t seed);

/// A network of the size of HemiCNN (docs/develop/specular.md) that has learned nothing.
NetworkDescription random_hemi_network(uint32_t seed);

}  // namespace patina
