// Whether a block stays on the device (shared/fusion/stream_blocks.h). Functions without bindings.
#ifndef PATINA_LIB_STREAM_REGION_GLSL
#define PATINA_LIB_STREAM_REGION_GLSL
#include "lib/map/voxel_map.glsl"
#include "shared/fusion/stream_blocks.h"

bool stays(VoxelGrid grid, StreamRegion region, uint key) {
    const ivec3 block = block_of_key(grid, key);
    const vec3 center_m = (vec3(block) + 0.5) * (grid.voxel_m * float(kBlockEdge));
    const bool in_box =
        all(greaterThanEqual(block, region.low_block.xyz)) && all(lessThanEqual(block, region.high_block.xyz));
    const vec3 offset_m = center_m - region.ball_m.xyz;
    const float distance_m = length(offset_m), far_m = length(region.cone_m.xyz);
    const float along_m = dot(offset_m, region.cone_m.xyz) / max(far_m, 1e-6);
    const bool in_cone = distance_m <= far_m && along_m >= region.cone_m.w * distance_m;
    return in_box && (distance_m <= region.ball_m.w || in_cone);
}

#endif
