// Counts the components in each group's range of keys.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/segmentation/number_segments.h"

layout(local_size_x = kNumberGroup) in;
layout(std430, binding = 0) readonly buffer Pixels { uvec4 pixels[]; };  // by key, four at a time
layout(std430, binding = 1) writeonly buffer Totals { KeyTotals totals[]; };
layout(push_constant) uniform Push { NumberSegmentsParams params; };

// A key that was joined to another has none of its own.
uvec4 key_pixels(uvec4 counts) { return mix(counts, uvec4(0u), greaterThanEqual(counts, uvec4(kForwardedKey))); }

shared uint kept;
shared uint too_small;

void main() {
    if (gl_LocalInvocationIndex == 0u) kept = too_small = 0u;
    barrier();
    const uint first = gl_GlobalInvocationID.x * kNumberQuads;
    uvec4 any_pixels = uvec4(0u), enough = uvec4(0u);
    for (uint i = 0u; i < kNumberQuads; ++i) {
        const uvec4 counts = key_pixels(pixels[first + i]);
        any_pixels += uvec4(greaterThan(counts, uvec4(0u)));
        enough += uvec4(greaterThanEqual(counts, uvec4(params.min_pixels)));
    }
    const uint here = enough.x + enough.y + enough.z + enough.w;
    const uint all = any_pixels.x + any_pixels.y + any_pixels.z + any_pixels.w;
    if (all > 0u) {
        atomicAdd(kept, here);
        atomicAdd(too_small, all - here);
    }
    barrier();
    if (gl_LocalInvocationIndex == 0u) totals[gl_WorkGroupID.x] = KeyTotals(kept, too_small);
}
