// The colour that belongs to each depth pixel. A group takes a row: in the colour picture the row of a depth pixel does
// not depend on its depth, so what hides it lies in the same row of depth pixels.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "shared/kinect2/register_color.h"

layout(local_size_x = kRegisterColorGroup) in;
layout(binding = 0, r32f) uniform readonly image2D depth_m;
layout(binding = 1, r32f) uniform readonly image2D place_x;  // colour column of what is infinitely far
layout(binding = 2, r32f) uniform readonly image2D place_y;
layout(std430, binding = 3) readonly buffer Color { uint words[]; };  // three bytes a pixel, without padding
layout(binding = 4, r32ui) uniform writeonly uimage2D registered;     // r | g << 8 | b << 16 | 255 << 24, or 0
layout(push_constant) uniform Push { RegisterColorParams params; };

const uint kTurns = kInfraredWidth / kRegisterColorGroup;
const uint kCells = kColorWidth / kCoverColumns;

// The least depth in each cell of columns, as the bits of a float: those order like the numbers. One more at each end.
shared uint nearest[kCells + 2u];

uint rgb_at(ivec2 at) {
    const uint bit = (uint(at.y) * kColorWidth + uint(at.x)) * 24u;
    const uint word = bit >> 5u, shift = bit & 31u;
    uint rgb = words[word] >> shift;
    // Only a pixel that crosses into the next word reads it: the last pixel may end the buffer.
    if (shift > 8u) rgb |= words[word + 1u] << (32u - shift);
    return rgb & 0xffffffu;
}

// Of a depth pixel, where its colour lies; outside of the picture where there is no reading.
ivec2 color_pixel(ivec2 pixel, float z) {
    const vec2 place = vec2(imageLoad(place_x, pixel).x + params.shift_px_m / z, imageLoad(place_y, pixel).x);
    const bool within = z > 0.0 && place.x >= -0.5 && place.y >= -0.5 && place.x < float(kColorWidth) - 0.5 &&
                        place.y < float(kColorHeight) - 0.5;
    return within ? ivec2(place + 0.5) : ivec2(-1);
}

// Depth pixels are three colour pixels apart: a surface leaves no gap of a cell and its neighbours.
bool hidden(uint cell, float z) {
    const uint least = min(nearest[cell], min(nearest[cell + 1u], nearest[cell + 2u]));
    return z - uintBitsToFloat(least) > params.tolerance * z;
}

void main() {
    const uint lane = gl_LocalInvocationID.x;
    const uint infinite = 0x7f800000u;
    for (uint i = lane; i < kCells + 2u; i += kRegisterColorGroup) nearest[i] = infinite;
    barrier();

    float z[kTurns];
    ivec2 at[kTurns];
    [[unroll]] for (uint turn = 0u; turn < kTurns; ++turn) {
        const ivec2 pixel = ivec2(turn * kRegisterColorGroup + lane, gl_WorkGroupID.y);
        z[turn] = imageLoad(depth_m, pixel).x;
        at[turn] = color_pixel(pixel, z[turn]);
        if (at[turn].x >= 0) atomicMin(nearest[uint(at[turn].x) / kCoverColumns + 1u], floatBitsToUint(z[turn]));
    }
    barrier();

    [[unroll]] for (uint turn = 0u; turn < kTurns; ++turn) {
        const ivec2 pixel = ivec2(turn * kRegisterColorGroup + lane, gl_WorkGroupID.y);
        uint color = 0u;
        if (at[turn].x >= 0 && !hidden(uint(at[turn].x) / kCoverColumns, z[turn]))
            color = 0xff000000u | rgb_at(at[turn]);
        imageStore(registered, pixel, uvec4(color));
    }
}
