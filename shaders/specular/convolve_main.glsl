// Body of the convolutions: 3 x 3, with bias and optionally ReLU and 2 x 2 max pooling, which then happens in registers
// and leaves out pixels that no pooled one needs.
//
// One invocation computes a quad of channels of a tile of pixels, so that what it loads is used often: loads take
// longer than arithmetic on software devices. Neighbouring invocations have neighbouring quads of the same tile.
#include "specular/weighted_layer.glsl"

layout(constant_id = 0) const uint kTileWidth = 2u;   // pixels; even if pooled
layout(constant_id = 1) const uint kTileHeight = 2u;  // likewise
layout(constant_id = 2) const uint kTileImages = 1u;  // the same tile in as many images
layout(constant_id = 3) const uint kPooled = 0u;
// Constants as well, since divisions by others take long.
layout(constant_id = 4) const uint kOutputQuads = 1u;
layout(constant_id = 5) const uint kTilesPerRow = 1u;
layout(constant_id = 6) const uint kTileRows = 1u;
layout(constant_id = 7) const uint kQuadInputs = 4u;  // of a quad, that are used

const uint kWindow = kTileWidth + kKernelSide - 1u;  // columns of the input that a tile's row needs

Quad sums[kTileImages * kTileHeight * kTileWidth];
Quads kernel[kKernelSide];  // a row of it, from a quad of inputs

void load_kernel(uint first) {
    [[unroll]] for (uint kx = 0u; kx < kKernelSide; ++kx) {
        const uint at = first + kx * params.input_quads * 4u * kOutputQuads;
        kernel[kx] = Quads(WEIGHT(at), WEIGHT(at + kOutputQuads), WEIGHT(at + 2u * kOutputQuads),
                           WEIGHT(at + 3u * kOutputQuads));
    }
}

// Adds what one input pixel gives to the pixels of its row, as far as they are in the tile.
void add_products(Quad value, uint row, uint column) {
    [[unroll]] for (uint kx = 0u; kx < kKernelSide; ++kx) {
        if (column < kx || column >= kTileWidth + kx) continue;
        const uint at = row * kTileWidth + column - kx;
        Quad sum = sums[at] + value.x * kernel[kx][0];
        if (kQuadInputs > 1u) sum += value.y * kernel[kx][1];
        if (kQuadInputs > 2u) sum += value.z * kernel[kx][2];
        if (kQuadInputs > 3u) sum += value.w * kernel[kx][3];
        sums[at] = sum;
    }
}

// Pixel by pixel, so that few sums are in use at a time.
void add_rows(uint first_image, ivec2 corner, uint quad) {
    const uint last_image = images_in_batch() - 1u;
    [[unroll]] for (uint i = 0u; i < kTileImages; ++i) {
        const uint image = min(first_image + i, last_image);
        [[unroll]] for (uint row = 0u; row < kTileHeight; ++row) {
            const uint y = uint(corner.y) + row;
            // What is left of or above the image is a very large number.
            const uint columns = y < params.input_side ? params.input_side : 0u;
            uint at =
                ((image * params.input_side + y) * params.input_side + uint(corner.x)) * params.input_quads + quad;
            [[unroll]] for (uint column = 0u; column < kWindow; ++column) {
                const bool inside = uint(corner.x) + column < columns;
                const Quad value = INPUT(inside ? at : 0u);
                add_products(inside ? value : Quad(0.0), i * kTileHeight + row, column);
                at += params.input_quads;
            }
        }
    }
}

void store(uint image, uvec2 pixel, uint quad, Quad value) {
    if (max(pixel.x, pixel.y) >= params.output_side) return;
    const uint at = (image * params.output_side + pixel.y) * params.output_side + pixel.x;
    OUTPUT(at * kOutputQuads + quad, activated(value));
}

void store_tile(uint first_image, uvec2 tile, uint quad) {
    const uint step = 1u + kPooled;
    [[unroll]] for (uint i = 0u; i < kTileImages; ++i) {
        if (first_image + i >= images_in_batch()) return;
        [[unroll]] for (uint row = 0u; row < kTileHeight; row += step) {
            [[unroll]] for (uint x = 0u; x < kTileWidth; x += step) {
                const uint at = (i * kTileHeight + row) * kTileWidth + x;
                Quad value = sums[at];
                if (kPooled != 0u) {
                    value = max(max(value, sums[at + 1u]), max(sums[at + kTileWidth], sums[at + kTileWidth + 1u]));
                }
                store(first_image + i, (tile * uvec2(kTileWidth, kTileHeight) + uvec2(x, row)) / step, quad, value);
            }
        }
    }
}

void main() {
    const uint item = gl_GlobalInvocationID.x, tile = item / kOutputQuads, tile_row = tile / kTilesPerRow;
    const uint quad = item % kOutputQuads;
    const uvec2 at = uvec2(tile % kTilesPerRow, tile_row % kTileRows);
    const uint first_image = tile_row / kTileRows * kTileImages;
    if (first_image >= images_in_batch()) return;
    const Quad bias = WEIGHT(params.biases + quad);
    [[unroll]] for (uint i = 0u; i < kTileImages * kTileHeight * kTileWidth; ++i) sums[i] = bias;
    const ivec2 corner = ivec2(at * uvec2(kTileWidth, kTileHeight)) - int(params.pad);
    [[dont_unroll]] for (uint ky = 0u; ky < kKernelSide; ++ky) {
        [[dont_unroll]] for (uint in_quad = 0u; in_quad < params.input_quads; ++in_quad) {
            const uint first_input = (ky * kKernelSide * params.input_quads + in_quad) * 4u;
            load_kernel(params.weights + first_input * kOutputQuads + quad);
            add_rows(first_image, corner + ivec2(0, ky), in_quad);
        }
    }
    store_tile(first_image, at, quad);
}
