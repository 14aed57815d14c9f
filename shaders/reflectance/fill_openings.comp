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

const float kLeastCosine = 0.7071;  // of 45 degrees
const uint kMostCounted = 16u;      // samples of a direction, from which on more do not tell more
const uint kWords = kOpeningTexels / 32u;

shared uint seen[kWords];  // a bit for each direction that was

vec3 direction_of(uint texel) {
    const vec2 at = vec2(texel % kOpeningEdge, texel / kOpeningEdge);
    return from_octahedral((at + 0.5) / float(kOpeningEdge) * 2.0 - 1.0);
}

uint samples_in(uint texel) { return samples_of(openings[texel].light); }

void main() {
    for (uint word = gl_LocalInvocationID.x; word < kWords; word += kOpeningGroup) {
        uint bits = 0u;
        for (uint bit = 0u; bit < 32u; ++bit)
            bits |= uint(samples_in(32u * word + bit) >= kLeastSurroundingsSamples) << bit;
        seen[word] = bits;
    }
    barrier();
    const uint own = gl_GlobalInvocationID.x * kOpeningTurns + params.turn;
    const vec3 direction = direction_of(own);
    const bool is_seen = (seen[own / 32u] >> own % 32u & 1u) != 0u;
    vec4 around = vec4(0.0);
    for (uint word = 0u; word < kWords; ++word) {
        for (uint bits = seen[word]; bits != 0u; bits &= bits - 1u) {
            const uint texel = 32u * word + uint(findLSB(bits));
            const float cosine = dot(direction, direction_of(texel));
            const float chord2 = max(2.0 - 2.0 * cosine, 1e-6);
            const float weight = float(min(samples_in(texel), kMostCounted)) / (chord2 * chord2);
            around += cosine < kLeastCosine ? vec4(0.0) : weight * vec4(mean_radiance(openings[texel].light), 1.0);
        }
    }
    const vec4 sum = is_seen ? vec4(mean_radiance(openings[own].light), 1.0) : around;
    const vec3 shown = sum.rgb / max(sum.a, 1e-30);
    openings[own].known = sum.a > 0.0 ? 1u : 0u;
    openings[own].r = shown.r;
    openings[own].g = shown.g;
    openings[own].b = shown.b;
}
