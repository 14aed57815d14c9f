// What the shaders of all kinds of layers have in common. The includer may define NETWORK_TEXELS, to read activations
// and weights through texel buffers, which software devices gather faster than storage buffers.
#ifndef PATINA_SPECULAR_LAYER_GLSL
#define PATINA_SPECULAR_LAYER_GLSL
#include "shared/network.h"

layout(local_size_x = kBatchGroup) in;
layout(std430, binding = 0) readonly buffer Batch { uint batch[]; };  // count, then labels
layout(std430, binding = 1) writeonly buffer Outputs { vec4 outputs[]; };
#ifdef NETWORK_TEXELS
layout(rgba32f, binding = 2) uniform readonly imageBuffer Inputs;
#define INPUT(i) imageLoad(Inputs, int(i))
#else
layout(std430, binding = 2) readonly buffer Inputs { vec4 inputs[]; };
#define INPUT(i) inputs[i]
#endif
layout(push_constant) uniform Push { LayerParams params; };

uint segments_in_batch() { return min(batch[0], params.capacity); }
uint images_in_batch() { return segments_in_batch() * params.images; }

#endif
