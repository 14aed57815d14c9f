// What layers have in common in every format. Included by the files that say how activations are stored,
// which define Quad, the type of four channels.
#ifndef PATINA_SPECULAR_LAYER_COMMON_GLSL
#define PATINA_SPECULAR_LAYER_COMMON_GLSL
#include "shared/specular/network.h"

layout(local_size_x = kBatchGroup) in;
layout(std430, binding = 0) readonly buffer Batch { uint batch[]; };  // count, then labels
layout(push_constant) uniform Push { LayerParams params; };

uint segments_in_batch() { return min(batch[0], params.capacity); }
uint images_in_batch() { return segments_in_batch() * params.images; }

Quad activated(Quad sum) { return params.relu != 0u ? max(sum, Quad(0.0)) : sum; }

#endif
