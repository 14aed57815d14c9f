#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// The label of each pixel: what the map says where it was asked nearby, on the same segment, or where
// the frame says nothing; else what its segment got.
#include "shared/segmentation/segments.h"

layout(local_size_x = kLabelGroup) in;
layout(constant_id = 0) const int kSegmentStride = 1;  // of the pixels in x and y, as to which segment they are of
layout(binding = 0, r32ui) uniform readonly uimage2D segment;
layout(binding = 1, r32ui) uniform readonly uimage2D map_label;
layout(binding = 2, r32ui) uniform readonly uimageBuffer Parents;
layout(binding = 3, r32ui) uniform readonly uimageBuffer SegmentLabels;
layout(binding = 4, r32ui) uniform writeonly uimage2D label;

void main() {
    // One of the map's labels, and the pixels around it.
    const ivec2 sampled = ivec2(gl_GlobalInvocationID.xy), extent = imageSize(label);
    const ivec2 first = sampled * int(kSampleStride);
    if (any(greaterThanEqual(first, extent))) return;
    // Labels may have merged since the map was sampled.
    const uint known = imageLoad(Parents, int(imageLoad(map_label, sampled).x)).x;
    const uint asked = imageLoad(segment, first / kSegmentStride).x;
    [[unroll]] for (int i = 0; i < int(kSampleStride * kSampleStride); ++i) {
        const ivec2 pixel = first + ivec2(i % int(kSampleStride), i / int(kSampleStride));
        const uint here = imageLoad(segment, pixel / kSegmentStride).x;
        const uint assigned = imageLoad(SegmentLabels, int(here)).x;
        const uint chosen = known != kNoLabel && (asked == here || here == 0u) ? known : assigned;
        if (all(lessThan(pixel, extent))) imageStore(label, pixel, uvec4(chosen));
    }
}
