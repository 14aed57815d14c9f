// Body of the 2 x 2 max pooling of layers that do not follow a convolution; an odd last row and column are left out.
#include "specular/layer.glsl"

void main() {
    const uint item = gl_GlobalInvocationID.x, pixel = item / params.output_quads;
    const uint quad = item % params.output_quads, row = pixel / params.output_side;
    const uvec2 at = uvec2(pixel % params.output_side, row % params.output_side);
    const uint image = row / params.output_side;
    if (image >= images_in_batch()) return;
    const uint side = params.input_side, quads = params.input_quads;
    const uint first = ((image * side + 2u * at.y) * side + 2u * at.x) * quads + quad;
    const Quad upper = max(INPUT(first), INPUT(first + quads));
    const Quad lower = max(INPUT(first + side * quads), INPUT(first + (side + 1u) * quads));
    OUTPUT(item, max(upper, lower));
}
