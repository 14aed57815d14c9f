// Joins components that have one strong colour along their contact: they are folds of one thing. One workgroup.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/segmentation/contacts.h"
#include "shared/segmentation/number_segments.h"

layout(local_size_x = kJoinFoldsGroup) in;
layout(std430, binding = 0) readonly buffer Contacts { Contact contacts[]; };
layout(std430, binding = 1) readonly buffer ContactCount { uint contact_count; };
layout(std430, binding = 2) coherent buffer Parents { uint parents[]; };  // by key - 1
layout(std430, binding = 3) coherent buffer Pixels { uint pixels[]; };    // by key
layout(push_constant) uniform Push { JoinFoldsParams params; };
#include "lib/math/disjoint_sets.glsl"

// Highlights take colours towards grey: the hue says more than the saturation.
bool is_fold(Contact contact) {
    const float pixels = max(float(contact.pixels), 1.0), scale = 1.0 / (kContactChroma * pixels);
    const vec2 low = vec2(contact.low_r, contact.low_g) * scale - 1.0 / 3.0;
    const vec2 high = vec2(contact.high_r, contact.high_g) * scale - 1.0 / 3.0;
    const float saturation = min(length(low), length(high));
    const float sine = abs(low.x * high.y - low.y * high.x) / max(length(low) * length(high), 1e-6);
    return saturation > params.strong_chroma && dot(low, high) > 0.0 && sine <= params.same_hue &&
           abs(length(low) - length(high)) <= params.same_saturation &&
           pixels * saturation * saturation >= params.least_weight;
}

// Moves a component's pixels to its root, once.
void forward(uint key) {
    const uint root = find_root(key - 1u) + 1u;
    if (root == key) return;
    const uint before = atomicExchange(pixels[key], kForwardedKey | root);
    if (before < kForwardedKey) atomicAdd(pixels[root], before);
}

void main() {
    if (contact_count >= kMostContacts) return;
    for (uint slot = gl_LocalInvocationIndex; slot < kContactSlots; slot += kJoinFoldsGroup) {
        const Contact contact = contacts[slot];
        if (is_fold(contact)) unite(contact.low - 1u, contact.high - 1u);
    }
    memoryBarrierBuffer();
    barrier();
    for (uint slot = gl_LocalInvocationIndex; slot < kContactSlots; slot += kJoinFoldsGroup) {
        const Contact contact = contacts[slot];
        if (!is_fold(contact)) continue;
        forward(contact.low);
        forward(contact.high);
    }
}
