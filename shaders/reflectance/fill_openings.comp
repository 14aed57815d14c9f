#version 460
#extension GL_GOOGLE_include_directive : require
// Finds for a part of all directions what openings show in them: what was seen, or the mean of what was seen around, 45
// degrees off at most, by the inverse fourth power of the angle. One direction alone may be a window's bar, or noise.
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

const uint kMostCounted = 16u;  // samples of a direction, from which on more do not tell more

uint samples_in(ivec2 texel) { return samples_of(openings[index_of(texel)].light); }

void main() {
    const uint index = gl_GlobalInvocationID.x * kOpeningTurns + params.turn;
    const ivec2 own = ivec2(index % kOpeningEdge, index / kOpeningEdge);
    const vec3 direction = direction_of(own);
    const bool is_seen = samples_in(own) >= kLeastSurroundingsSamples;
    vec4 sum = is_seen ? vec4(mean_radiance(openings[index].light), 1.0) : vec4(0.0);
    const int reach = is_seen ? -1 : kReachTexels;
    for (int y = -reach; y <= reach; ++y) {
        for (int x = -reach; x <= reach; ++x) {
            const ivec2 at = own + ivec2(x, y), texel = wrapped(at);
            // What lies beyond a side of the map may be on its other half, which is looked at anyway.
            if (texel != at && all(lessThanEqual(abs(texel - own), ivec2(reach)))) continue;
            const uint samples = samples_in(texel);
            if (samples < kLeastSurroundingsSamples) continue;
            const float cosine = dot(direction, direction_of(texel));
            if (cosine < kLeastCosine) continue;
            const float chord2 = max(2.0 - 2.0 * cosine, 1e-6);
            const float weight = float(min(samples, kMostCounted)) / (chord2 * chord2);
            sum += weight * vec4(mean_radiance(openings[index_of(texel)].light), 1.0);
        }
    }
    const vec3 shown = sum.rgb / max(sum.a, 1e-30);
    openings[index].known = sum.a > 0.0 ? 1u : 0u;
    openings[index].r = shown.r;
    openings[index].g = shown.g;
    openings[index].b = shown.b;
}
