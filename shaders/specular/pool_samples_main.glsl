// Body of the mean and maximum of each channel over the samples of a segment, whose order therefore does not matter:
// all means, then all maxima.
#include "specular/layer.glsl"

void main() {
    const uint item = gl_GlobalInvocationID.x;
    const uint segment = item / params.input_quads, quad = item % params.input_quads;
    if (segment >= segments_in_batch()) return;
    const uint first = segment * params.images * params.input_quads + quad;
    Quad most = INPUT(first);
    vec4 sum = vec4(most);
    for (uint i = 1u; i < params.images; ++i) {
        const Quad value = INPUT(first + i * params.input_quads);
        sum += vec4(value);
        most = max(most, value);
    }
    OUTPUT(segment * params.output_quads + quad, Quad(sum / float(params.images)));
    OUTPUT(segment * params.output_quads + params.input_quads + quad, most);
}
