// Inference of a small convolutional network, one batch of segments at a time. See passes/specular/run_network.h.
#ifndef PATINA_SHARED_NETWORK_H
#define PATINA_SHARED_NETWORK_H
#include "shared/specular/segment_batch.h"
INTEROP_BEGIN

INTEROP_CONST uint kKernelSide = 3u;  // of convolutions

// What one layer reads and writes. Activations are quads [image][y][x][quad] of four channels of one pixel; those
// beyond the last do not count, as their weights are 0. Weights are quads of four outputs: [ky][kx][input][output
// quad], then the biases. A quad is a vec4 or, in 16-bit floats, a uvec2 of halves; but for the images that go into the
// first layer and what the last one gives, which are always vec4.
struct LayerParams {
    uint images;       // per segment; 1 once the samples are pooled
    uint input_side;   // pixels
    uint output_side;  // pixels that are stored
    uint pad;          // zeros around the input
    uint input_quads;  // quads per pixel
    uint output_quads;
    uint weights;   // the first, in quads
    uint biases;    // the first, in quads
    uint relu;      // 0: none
    uint capacity;  // segments that the activations have room for
};

INTEROP_END
#endif
