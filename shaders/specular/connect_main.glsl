// Body of the fully connected layers, with bias and optionally ReLU. One invocation computes a quad of outputs.
#include "specular/weighted_layer.glsl"

void main() {
    const uint item = gl_GlobalInvocationID.x;
    const uint segment = item / params.output_quads, quad = item % params.output_quads;
    if (segment >= segments_in_batch()) return;
    vec4 sum = vec4(WEIGHT(params.biases + quad));
    for (uint i = 0u; i < params.input_quads; ++i) {
        const vec4 value = vec4(INPUT(segment * params.input_quads + i));
        const uint first = params.weights + i * 4u * params.output_quads + quad;
        [[unroll]] for (uint c = 0u; c < 4u; ++c) sum += value[c] * vec4(WEIGHT(first + c * params.output_quads));
    }
    OUTPUT(item, activated(Quad(sum)));
}
