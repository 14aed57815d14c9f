// Gives pixels without a component, such as edges, to the one nearby whose tangent plane they lie on; and collects the
// colours on both sides of those that lie on two planes, as the crease between two components does.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "lib/chroma.glsl"
#include "lib/frame_surface.glsl"
#include "lib/voxel_map.glsl"
#include "shared/contacts.h"

layout(local_size_x = 32, local_size_y = 4) in;
layout(binding = 0, r32f) uniform readonly image2D depth_m;
layout(binding = 1, r32ui) uniform readonly uimage2D normal;
layout(binding = 2, r32ui) uniform readonly uimage2D chroma;
layout(binding = 3, r32ui) uniform readonly uimage2D component;
layout(std430, binding = 4) readonly buffer Pixels { uint pixels[]; };  // by component; of 0: 0
layout(binding = 5, r32ui) uniform writeonly uimage2D claimed;
layout(std430, binding = 6) coherent buffer Contacts { Contact contacts[]; };
layout(std430, binding = 7) coherent buffer ContactCount { uint contact_count; };
layout(push_constant) uniform Push { FrameSurfaceParams params; };

const ivec2 kDirections[4] = ivec2[](ivec2(-1, 0), ivec2(1, 0), ivec2(0, -1), ivec2(0, 1));
const float kChromaWeightM = 0.05;  // a difference of colour counts as so much distance from a plane
const float kFoldCostM = 1.0;       // any plane on which a pixel lies is preferred to one that it folds away from

ivec2 clamped(ivec2 pixel) { return clamp(pixel, ivec2(0), ivec2(params.extent) - 1); }

// 0 for components that are too small.
uint large(uint key) { return pixels[key] >= params.min_pixels ? key : 0u; }

// A table that is three quarters full takes no more pairs, and none of them counts then.
void add_contact(uint a, uint a_chroma, uint b, uint b_chroma) {
    const bool in_order = a < b;
    const uint low = in_order ? a : b, high = in_order ? b : a;
    const uint low_chroma = in_order ? a_chroma : b_chroma, high_chroma = in_order ? b_chroma : a_chroma;
    uint slot = hash_of_key(low * 0x9e3779b9u + high) & (kContactSlots - 1u);
    for (;;) {
        if (contact_count >= kMostContacts) return;
        const uint first = atomicCompSwap(contacts[slot].low, 0u, low);
        if (first == 0u) atomicAdd(contact_count, 1u);
        if (first == 0u || first == low) {
            const uint second = atomicCompSwap(contacts[slot].high, 0u, high);
            if (second == 0u || second == high) break;
        }
        slot = (slot + 1u) & (kContactSlots - 1u);
    }
    atomicAdd(contacts[slot].pixels, 1u);
    atomicAdd(contacts[slot].low_r, low_chroma & 0xfffu);
    atomicAdd(contacts[slot].low_g, low_chroma >> 12 & 0xfffu);
    atomicAdd(contacts[slot].high_r, high_chroma & 0xfffu);
    atomicAdd(contacts[slot].high_g, high_chroma >> 12 & 0xfffu);
}

void main() {
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(params.extent)))) return;
    uint own = large(imageLoad(component, pixel).x);
    const float z = imageLoad(depth_m, pixel).x;
    const bool wanting = own == 0u && z > 0.0;

    // The nearest component in each direction. No branch: software devices leave the loop as soon as no pixel of a
    // vector needs it.
    uvec4 found = uvec4(0u);
    ivec4 apart = ivec4(0);
    for (int step = 1; wanting && any(equal(found, uvec4(0u))) && step <= params.claim_reach_px; ++step) {
        [[unroll]] for (int i = 0; i < 4; ++i) {
            // Beyond the image loads are zero.
            const uint there = imageLoad(component, pixel + step * kDirections[i]).x;
            apart[i] = found[i] == 0u ? step : apart[i];
            found[i] = found[i] == 0u ? there : found[i];
        }
    }
    if (any(notEqual(found, uvec4(0u)))) {
        [[unroll]] for (int i = 0; i < 4; ++i) found[i] = large(found[i]);
        const vec3 point_m = surface_point_m(params, pixel, z);
        const float limit_m = params.claim_m + params.claim_sigmas * depth_sigma_m(params, z);
        const uint color = imageLoad(chroma, pixel).x;
        float least = 1e9;
        uvec4 colors = uvec4(0u);  // of the components on whose plane the pixel lies
        [[unroll]] for (int i = 0; i < 4; ++i) {
            const ivec2 place = clamped(pixel + apart[i] * kDirections[i]);
            const vec3 there_m = surface_point_m(params, place, imageLoad(depth_m, place).x);
            const uint there = imageLoad(chroma, place).x;
            // Above 0 where the pixel lies behind the plane, as over a convex fold.
            const float behind_m = dot(there_m - point_m, unpack_normal(imageLoad(normal, place).x));
            const float distance_m = abs(behind_m);
            const vec2 differing = abs(unpack_chroma(there) - unpack_chroma(color));
            const bool colored = there != 0u && color != 0u;
            const float cost = distance_m + (colored ? kChromaWeightM * max(differing.x, differing.y) : 0.0);
            const bool on_plane = found[i] != 0u && distance_m < limit_m;
            colors[i] = on_plane ? there : 0u;
            const bool same_hue = colored && hue_change(unpack_chroma(there), unpack_chroma(color)) < params.cut_chroma;
            const bool folded =
                found[i] != 0u && behind_m > 0.0 && same_hue && abs(there_m.z - z) <= jump_limit_m(params, z, apart[i]);
            const float paid = on_plane ? cost : folded ? kFoldCostM + cost : 1e9;
            own = paid < least ? found[i] : own;
            least = min(least, paid);
        }
        [[unroll]] for (int i = 0; i < 4; i += 2) {
            if (found[i] != found[i + 1] && colors[i] != 0u && colors[i + 1] != 0u)
                add_contact(found[i], colors[i], found[i + 1], colors[i + 1]);
        }
    }
    imageStore(claimed, pixel, uvec4(own));
}
