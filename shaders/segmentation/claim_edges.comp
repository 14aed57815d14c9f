// Gives pixels without a component, such as edges, to the one nearby whose tangent plane they lie on; and collects the
// colours on both sides of those that lie on two planes, as the crease between two components does. A group lists the
// pixels of its tile that have none before it looks at them: software devices run a branch whether a pixel takes it or
// not, and a loop's body at least once in all vectors of a group.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "lib/color/chroma.glsl"
#include "lib/map/voxel_map.glsl"
#include "lib/segments/frame_surface.glsl"
#include "shared/segmentation/contacts.h"

layout(local_size_x = kClaimGroup) in;
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

shared uint listed;
shared uint list[kClaimGroup * kClaimRows];  // x and y << 16 of pixels without a component, in any order

// An invocation goes down a column of the tile. What has a component keeps it, where there is nothing none is needed.
void list_wanting(ivec2 corner) {
    const int x = corner.x + int(gl_LocalInvocationIndex);
    uint wanting = 0u;
    [[unroll]] for (int i = 0; i < int(kClaimRows); ++i) {
        const ivec2 pixel = ivec2(x, corner.y + i);
        // Beyond the image loads are zero.
        const uint own = large(imageLoad(component, pixel).x);
        const bool wants = own == 0u && imageLoad(depth_m, pixel).x > 0.0;
        wanting |= uint(wants) << i;
        if (!wants && all(lessThan(pixel, ivec2(params.extent)))) imageStore(claimed, pixel, uvec4(own));
    }
    uint place = wanting == 0u ? 0u : atomicAdd(listed, uint(bitCount(wanting)));
    for (uint bits = wanting; bits != 0u; bits &= bits - 1u) {
        list[place++] = uint(x) | uint(corner.y + findLSB(bits)) << 16;
    }
}

// The nearest component in each direction, 0 where there is none near enough or it is too small; `apart`: how far.
uvec4 nearest_components(ivec2 pixel, out ivec4 apart) {
    uvec4 found = uvec4(0u);
    apart = ivec4(0);
    for (int step = 1; any(equal(found, uvec4(0u))) && step <= params.claim_reach_px; ++step) {
        [[unroll]] for (int i = 0; i < 4; ++i) {
            const uint there = imageLoad(component, pixel + step * kDirections[i]).x;
            apart[i] = found[i] == 0u ? step : apart[i];
            found[i] = found[i] == 0u ? there : found[i];
        }
    }
    [[unroll]] for (int i = 0; i < 4; ++i) found[i] = large(found[i]);
    return found;
}

// The component that a pixel joins, 0 if none.
uint claimed_by(ivec2 pixel, uvec4 found, ivec4 apart) {
    const float z = imageLoad(depth_m, pixel).x;
    const vec3 point_m = surface_point_m(params, pixel, z);
    const float limit_m = params.claim_m + params.claim_sigmas * depth_sigma_m(params, z);
    const uint color = imageLoad(chroma, pixel).x;
    uint own = 0u;
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
    return own;
}

void main() {
    if (gl_LocalInvocationIndex == 0u) listed = 0u;
    barrier();
    list_wanting(ivec2(gl_WorkGroupID.xy * uvec2(kClaimGroup, kClaimRows)));
    barrier();
    const uint count = listed;
    for (uint i = gl_LocalInvocationIndex; i < count; i += kClaimGroup) {
        const ivec2 pixel = ivec2(list[i] & 0xffffu, list[i] >> 16);
        ivec4 apart;
        const uvec4 found = nearest_components(pixel, apart);
        imageStore(claimed, pixel, uvec4(claimed_by(pixel, found, apart)));
    }
}
