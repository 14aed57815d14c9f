// Writes into every pixel the number of its segment, and adds up what is known of each, 32 pixels of a row at a time.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/camera.glsl"
#include "shared/number_segments.h"

layout(local_size_x = kMeasureGroup) in;
layout(binding = 0, r32ui) uniform readonly uimage2D keys;  // 0: none
layout(binding = 1, r32f) uniform readonly image2D depth_m;
layout(std430, binding = 2) readonly buffer Pixels { uint pixels[]; };    // by key
layout(std430, binding = 3) readonly buffer Numbers { uint numbers[]; };  // by key; only where enough pixels are
layout(std430, binding = 4) buffer Segments { FrameSegment segments[]; };
layout(binding = 5, r32ui) uniform writeonly uimage2D segment;
layout(push_constant) uniform Push { MeasureSegmentsParams params; };

// Pixels in a row that belong to one segment.
struct Sum {
    uint number;
    uint pixels;
    uint first_x;
    ivec3 whole_m;
    uvec3 fraction;
};

void add(Sum sum, uint y) {
    if (sum.number == 0u) return;
    const uvec2 last = params.camera.extent - 1u;
    const uint last_x = sum.first_x + sum.pixels - 1u;
    const bool at_border = sum.first_x == 0u || last_x == last.x || y == 0u || y == last.y;
    atomicAdd(segments[sum.number].pixels, sum.pixels);
    atomicOr(segments[sum.number].touches_border, uint(at_border));
    atomicMin(segments[sum.number].min_x, sum.first_x);
    atomicMin(segments[sum.number].min_y, y);
    atomicMax(segments[sum.number].max_x, last_x);
    atomicMax(segments[sum.number].max_y, y);
    atomicAdd(segments[sum.number].whole_x_m, sum.whole_m.x);
    atomicAdd(segments[sum.number].whole_y_m, sum.whole_m.y);
    atomicAdd(segments[sum.number].whole_z_m, sum.whole_m.z);
    atomicAdd(segments[sum.number].fraction_x, sum.fraction.x);
    atomicAdd(segments[sum.number].fraction_y, sum.fraction.y);
    atomicAdd(segments[sum.number].fraction_z, sum.fraction.z);
}

uint number_of(uint key) {
    if (key >= params.keys) return 0u;
    uint count = pixels[key];
    if (count >= kForwardedKey) {
        key = count & ~kForwardedKey;
        count = pixels[key];
    }
    return count >= params.min_pixels ? numbers[key] : 0u;
}

void main() {
    const uint index = gl_GlobalInvocationID.x;
    const uvec2 extent = params.camera.extent;
    if (index >= params.row_words * extent.y) return;
    const ivec2 first = ivec2(index % params.row_words * 32u, index / params.row_words);
    const vec3 center_m = camera_center_m(params.camera);
    const int count = min(32, int(extent.x) - first.x);
    uint key = 0u, number_of_key = 0u;
    Sum sum = Sum(0u, 0u, 0u, ivec3(0), uvec3(0u));
    for (int i = 0; i < count; ++i) {
        const ivec2 pixel = first + ivec2(i, 0);
        const uint here = imageLoad(keys, pixel).x;
        const float z = imageLoad(depth_m, pixel).x;
        if (here != key) {
            key = here;
            number_of_key = number_of(here);
        }
        const uint number = z > 0.0 ? number_of_key : 0u;
        imageStore(segment, pixel, uvec4(number));
        const vec3 point = unproject(params.camera, vec2(pixel)) * z;
        const vec3 world_m = to_world_direction(params.camera, point) + center_m;
        if (number != sum.number) {
            add(sum, uint(first.y));
            sum = Sum(number, 0u, uint(pixel.x), ivec3(0), uvec3(0u));
        }
        const vec3 whole_m = floor(world_m);
        sum.pixels += 1u;
        sum.whole_m += ivec3(whole_m);
        sum.fraction += uvec3((world_m - whole_m) * kSegmentFractionsPerM + 0.5);
    }
    add(sum, uint(first.y));
}
