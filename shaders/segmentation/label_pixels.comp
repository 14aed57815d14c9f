#version 460
#extension GL_GOOGLE_include_directive : require
// The label of each pixel: what the map says where it was asked nearby, on the same segment, or where
// the frame says nothing; else what its segment got.
#include "shared/segments.h"

layout(local_size_x = kLabelGroupX, local_size_y = kLabelGroupY) in;
layout(constant_id = 0) const int kSegmentStride = 1;  // of the pixels in x and y, as to which segment they are of
layout(binding = 0, r32ui) uniform readonly uimage2D segment;
layout(binding = 1, r32ui) uniform readonly uimage2D map_label;
layout(binding = 2, r32ui) uniform readonly uimageBuffer Parents;
layout(binding = 3, r32ui) uniform readonly uimageBuffer SegmentLabels;
layout(binding = 4, r32ui) uniform writeonly uimage2D label;

void main() {
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(label)))) return;
    // Labels may have merged since the map was sampled.
    const ivec2 sampled = pixel / int(kSampleStride);
    const uint known = imageLoad(Parents, int(imageLoad(map_label, sampled).x)).x;
    const uint here = imageLoad(segment, pixel / kSegmentStride).x;
    const bool same = imageLoad(segment, sampled * int(kSampleStride) / kSegmentStride).x == here;
    const uint assigned = imageLoad(SegmentLabels, int(here)).x;
    imageStore(label, pixel, uvec4(known != kNoLabel && (same || here == 0u) ? known : assigned));
}
