#version 460
#extension GL_GOOGLE_include_directive : require
// Walks each reading's truncation band through the grid of blocks and inserts the keys that the table lacks.
#include "lib/camera/camera.glsl"
#include "lib/map/voxel_map.glsl"
#include "shared/fusion/allocate_blocks.h"

layout(local_size_x = kTouchGroupX, local_size_y = kTouchGroupY) in;
layout(binding = 0, r32f) uniform readonly image2D depth_m;
layout(std140, binding = 1) uniform Fusion { FusionParams fusion; };
layout(std430, binding = 2) coherent buffer Keys { uint keys[]; };
layout(std430, binding = 3) writeonly buffer NewSlots { uint new_slots[]; };
layout(std430, binding = 4) buffer Counters { MapCounters counters; };

#include "lib/map/insert_key.glsl"

void touch(uint key, bool may_insert) {
    const Insertion at = insert_key(fusion.grid, key, may_insert);
    if (at.fresh) new_slots[atomicAdd(counters.new_keys, 1u)] = at.slot;
    if (at.slot == kNoSlot) atomicAdd(counters.refused_samples, 1u);
}

void main() {
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy * fusion.stride_px) +
                        ivec2(fusion.phase % fusion.stride_px, fusion.phase / fusion.stride_px % fusion.stride_px);
    if (any(greaterThanEqual(pixel, ivec2(fusion.depth_camera.extent)))) return;
    const float depth = imageLoad(depth_m, pixel).x;
    if (!(depth > 0.0) || depth > fusion.max_depth_m) return;

    const float truncation = fusion.truncation_m + fusion.truncation_slope * depth;
    const float block_m = fusion.grid.voxel_m * float(kBlockEdge);
    const vec3 direction = to_world_direction(fusion.depth_camera, unproject(fusion.depth_camera, vec2(pixel)));
    const vec3 center = camera_center_m(fusion.depth_camera);
    const vec3 from = (center + direction * (depth - truncation)) / block_m;
    const vec3 to = (center + direction * (depth + truncation)) / block_m;

    // Amanatides and Woo's walk; the band of one reading is a few blocks long.
    ivec3 block = ivec3(floor(from));
    const ivec3 last = ivec3(floor(to));
    const vec3 span = to - from;
    const ivec3 step_sign = ivec3(sign(span));
    const vec3 delta = 1.0 / max(abs(span), vec3(1e-9));
    // Along an axis that the ray keeps clear of, the next boundary is far away, even when the ray lies in one.
    vec3 next = mix(from - vec3(block), vec3(block + 1) - from, greaterThanEqual(span, vec3(0.0))) * delta;
    const int steps = abs(last.x - block.x) + abs(last.y - block.y) + abs(last.z - block.z);
    const bool may_insert = counters.table_keys < fusion.max_table_keys;
    for (int i = 0; i <= steps; ++i) {
        const uint key = key_of_block(fusion.grid, block);
        if (key == kEmptyKey) {
            atomicAdd(counters.outside_samples, 1u);
        } else {
            touch(key, may_insert);
        }
        const bool x = next.x <= next.y && next.x <= next.z;
        const bool y = !x && next.y <= next.z;
        const bvec3 axis = bvec3(x, y, !x && !y);
        block += mix(ivec3(0), step_sign, axis);
        next += mix(vec3(0.0), delta, axis);
    }
}
