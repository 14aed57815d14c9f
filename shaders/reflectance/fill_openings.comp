#version 460
#extension GL_GOOGLE_include_directive : require
// Finds for a part of all directions the nearest one, 45 degrees off at most, that an opening showed something in.
#include "lib/lighting/surroundings.glsl"
#include "lib/math/octahedral.glsl"
#include "shared/reflectance/far_field.h"

layout(local_size_x = kOpeningGroup) in;
layout(std430, binding = 0) buffer Surroundings{SURROUNDINGS_MEMBERS};
layout(push_constant) uniform Push { OpeningParams params; };

const int kReachTexels = 26;        // 45 degrees around an axis of the octahedron, more elsewhere
const float kLeastCosine = 0.7071;  // of 45 degrees
const int kEdge = int(kOpeningEdge);

// Beyond a side of the map lies what is beside it, turned around the side's middle.
ivec2 wrapped(ivec2 texel) {
    if (texel.x < 0 || texel.x >= kEdge)
        texel = ivec2(texel.x < 0 ? -1 - texel.x : 2 * kEdge - 1 - texel.x, kEdge - 1 - texel.y);
    if (texel.y < 0 || texel.y >= kEdge)
        texel = ivec2(kEdge - 1 - texel.x, texel.y < 0 ? -1 - texel.y : 2 * kEdge - 1 - texel.y);
    return texel;
}

uint index_of(ivec2 texel) { return uint(texel.y) * kOpeningEdge + uint(texel.x); }

vec3 direction_of(ivec2 texel) { return from_octahedral((vec2(texel) + 0.5) / float(kEdge) * 2.0 - 1.0); }

bool is_seen(ivec2 texel) { return samples_of(openings[index_of(texel)].light) >= kLeastSurroundingsSamples; }

void main() {
    const uint index = gl_GlobalInvocationID.x * kOpeningTurns + params.turn;
    const ivec2 own = ivec2(index % kOpeningEdge, index / kOpeningEdge);
    const vec3 direction = direction_of(own);
    float best = kLeastCosine;
    uint nearest = 0u;
    const int reach = is_seen(own) ? 0 : kReachTexels;
    for (int y = -reach; y <= reach; ++y) {
        for (int x = -reach; x <= reach; ++x) {
            const ivec2 texel = wrapped(own + ivec2(x, y));
            if (!is_seen(texel)) continue;
            const float cosine = dot(direction, direction_of(texel));
            if (cosine <= best) continue;
            best = cosine;
            nearest = index_of(texel) + 1u;
        }
    }
    openings[index].nearest = nearest;
}
