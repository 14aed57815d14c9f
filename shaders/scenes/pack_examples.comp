#version 460
#extension GL_GOOGLE_include_directive : require
// HemiImages as a file of examples has them: red, green and blue of all pixels as 16-bit floats, which hold every
// colour of an observation exactly.
#include "shared/scenes/example_scenes.h"

layout(local_size_x = kExampleGroup) in;
layout(std430, binding = 0) readonly buffer Images { vec4 images[]; };
layout(std430, binding = 1) writeonly buffer Halves { uint halves[]; };
layout(push_constant) uniform Push { ExampleParams params; };

const uint kValues = kHemiSamples * kHemiPixels * 3u;

float value_at(uint scene, uint index) {
    return index < kValues ? images[scene * (kValues / 3u) + index / 3u][index % 3u] : 0.0;
}

void main() {
    const uint word = gl_GlobalInvocationID.x, scene = word / (kExampleHalves / 2u);
    if (scene >= params.scenes) return;
    const uint index = word % (kExampleHalves / 2u) * 2u;
    halves[word] = packHalf2x16(vec2(value_at(scene, index), value_at(scene, index + 1u)));
}
