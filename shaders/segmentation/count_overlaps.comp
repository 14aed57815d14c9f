#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// Counts the pixels that each segment of the frame shares with each label of the map, and collects the chromaticity of
// labels. An invocation goes along a strip of a row and counts runs.
#include "lib/camera/camera.glsl"
#include "lib/map/voxel_map.glsl"
#include "shared/segmentation/segments.h"

layout(local_size_x = kStripGroupX, local_size_y = kStripGroupY) in;
layout(binding = 0, r32ui) uniform readonly uimage2D segment;
layout(binding = 1, r32ui) uniform readonly uimage2D map_label;
layout(binding = 2, rgba32f) uniform readonly image2D position_m;
layout(binding = 3, rgba16f) uniform readonly image2D color_linear;
layout(std140, binding = 4) uniform Segmentation { SegmentationParams frame; };
layout(std430, binding = 5) coherent buffer Overlaps { SegmentOverlap overlaps[]; };
layout(std430, binding = 6) coherent buffer OverlapList { uint overlap_list[]; };  // entries asked for, then slots
layout(std430, binding = 7) buffer Labels { SegmentLabel labels[]; };

layout(constant_id = 0) const int kSegmentStride = 1;  // of the pixels in x and y, as to which segment they are of

const int kStride = int(kSampleStride);

// Adds to the entry of a key. A table that is three quarters full takes no more keys: the frame is then left out as a
// whole, so that it does not matter which came first.
void count(uint key, uint pixels) {
    if (key >> 16 == 0u || (key & 0xffffu) == kNoLabel) return;
    uint slot = hash_of_key(key) & (frame.overlap_slots - 1u);
    for (;;) {
        if (overlap_list[0] >= frame.overlap_slots / 4u * 3u) return;
        const uint found = overlaps[slot].key;
        if (found == key) break;
        if (found == 0u) {
            const uint before = atomicCompSwap(overlaps[slot].key, 0u, key);
            if (before == 0u) overlap_list[1u + atomicAdd(overlap_list[0], 1u)] = slot;
            if (before == 0u || before == key) break;
        }
        slot = (slot + 1u) & (frame.overlap_slots - 1u);
    }
    atomicAdd(overlaps[slot].pixels, pixels * kSampleStride * kSampleStride);
}

// One pixel of each strip, another in every frame. Clipped colours say nothing of the surface.
void collect_chroma(ivec2 pixel, uint label) {
    if (label == kNoLabel) return;
    const vec3 at = to_camera(frame.color_camera, imageLoad(position_m, pixel * kStride).xyz);
    if (at.z <= 0.0) return;
    const vec4 seen = imageLoad(color_linear, ivec2(floor(project(frame.color_camera, at) + 0.5)));
    const float sum = seen.r + seen.g + seen.b;
    if (seen.a < 1.0 || sum < 0.01) return;
    atomicAdd(labels[label].chroma_samples, 1u);
    atomicAdd(labels[label].chroma_r, uint(seen.r / sum * kChromaSteps + 0.5));
    atomicAdd(labels[label].chroma_g, uint(seen.g / sum * kChromaSteps + 0.5));
}

void main() {
    const ivec2 first = ivec2(gl_GlobalInvocationID.xy) * ivec2(kStripPixels, 1);
    if (any(greaterThanEqual(first, imageSize(map_label)))) return;
    uint key = 0u, run = 0u;
    // Beyond the image's border loads are zero: no segment.
    [[unroll]] for (int i = 0; i < int(kStripPixels); ++i) {
        const ivec2 pixel = first + ivec2(i, 0);
        const uint here = imageLoad(map_label, pixel).x | imageLoad(segment, pixel * kStride / kSegmentStride).x << 16;
        if (here != key) {
            count(key, run);
            key = here;
            run = 0u;
        }
        ++run;
    }
    count(key, run);
    if ((frame.stamp + gl_GlobalInvocationID.y) % 4u == 0u) {
        const ivec2 chosen = first + ivec2(frame.stamp / 4u % kStripPixels, 0);
        collect_chroma(chosen, imageLoad(map_label, chosen).x);
    }
}
