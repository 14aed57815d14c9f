#version 460
#extension GL_GOOGLE_include_directive : require
// Mean and maximum of each channel over the samples of a segment, whose order therefore does not matter: all means,
// then all maxima.
#include "specular/layer.glsl"

void main() {
    const uint item = gl_GlobalInvocationID.x;
    const uint segment = item / params.input_quads, quad = item % params.input_quads;
    if (segment >= segments_in_batch()) return;
    const uint first = segment * params.images * params.input_quads + quad;
    vec4 sum = INPUT(first), most = INPUT(first);
    for (uint i = 1u; i < params.images; ++i) {
        const vec4 value = INPUT(first + i * params.input_quads);
        sum += value;
        most = max(most, value);
    }
    outputs[segment * params.output_quads + quad] = sum / float(params.images);
    outputs[segment * params.output_quads + params.input_quads + quad] = most;
}
