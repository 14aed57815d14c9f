#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/math/gaussian.glsl"
#include "lib/math/random.glsl"
#include "shared/scenes/encode_depth.h"

layout(local_size_x = 32, local_size_y = 4) in;
layout(r32f, binding = 0) uniform readonly image2D depth_m;
layout(r32ui, binding = 1) uniform readonly uimage2D object_id;
layout(std430, binding = 2) writeonly buffer Encoded { uint encoded[]; };
layout(push_constant) uniform Push { EncodeDepthParams params; };

// Neighbours whose depths differ by a larger share are different surfaces: a plane seen by a camera of f = 365 pixels
// would have to lie within 5 degrees of the line of sight.
const float kEdge = 0.03;

// Of the four neighbours behind or before an edge, the depth of the farthest away from this pixel's; its own where it
// is at no edge.
float across_edge(ivec2 pixel, float own_m) {
    const ivec2 last = ivec2(params.extent) - 1;
    float across_m = own_m;
    for (int i = 0; i < 4; ++i) {
        const ivec2 step = (i & 1) == 0 ? ivec2(i - 1, 0) : ivec2(0, i - 2);
        const float other_m = imageLoad(depth_m, clamp(pixel + step, ivec2(0), last)).x;
        const float jump_m = abs(other_m - own_m);
        const bool edge = other_m > 0.0 && jump_m > kEdge * min(own_m, other_m);
        if (edge && jump_m > abs(across_m - own_m)) across_m = other_m;
    }
    return across_m;
}

float measured_m(uvec2 pixel, float own_m) {
    const uvec2 stream = random_stream(params.seed, params.frame, pixel.x | pixel.y << 16u);
    const vec4 numbers = unit_interval(random_words(stream, 0u, kDepthNoise));
    const bool flies = numbers.x < params.flying_pixels;
    const float across_m = flies ? across_edge(ivec2(pixel), own_m) : own_m;
    const float seen_m = own_m + numbers.y * (across_m - own_m);
    const float from_offset_m = seen_m - params.offset_m;
    const float sigma_m = params.constant_m + params.quadratic_per_m * from_offset_m * from_offset_m;
    return seen_m + sigma_m * gaussians(numbers.zw).x;
}

void main() {
    const uvec2 pixel = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(pixel, params.extent))) return;
    const float own_m = imageLoad(depth_m, ivec2(pixel)).x;
    const float read_m = own_m > 0.0 ? measured_m(pixel, own_m) : 0.0;
    const float units = floor(read_m * params.units_per_metre + 0.5);
    const uint depth = units >= 0.0 && units <= 65535.0 ? uint(units) : 0u;
    encoded[pixel.y * params.extent.x + pixel.x] = depth | imageLoad(object_id, ivec2(pixel)).x << 16u;
}
