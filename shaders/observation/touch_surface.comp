#version 460
#extension GL_GOOGLE_include_directive : require
// Finds, for every pixel looked at, the observation voxel that holds the model's surface there, and inserts the keys of
// blocks that the table lacks. Pixels that could not observe it are left out: those where the reading is not the
// model's surface, or where it is far or grazing.
#include "lib/camera/camera.glsl"
#include "lib/map/slope.glsl"
#include "lib/map/voxel_map.glsl"
#include "lib/records/observations.glsl"

layout(local_size_x = kObservationGroupX, local_size_y = kObservationGroupY) in;
layout(binding = 0, rgba32f) uniform readonly image2D position_m;
layout(binding = 1, rgba16f) uniform readonly image2D normal;
layout(binding = 2, r32f) uniform readonly image2D depth_m;
layout(binding = 3, r32ui) uniform readonly uimage2D slope;
layout(std140, binding = 4) uniform Observation { ObservationParams frame; };
layout(std430, binding = 5) coherent buffer Keys { uint keys[]; };
layout(std430, binding = 6) writeonly buffer NewSlots { uint new_slots[]; };
layout(std430, binding = 7) buffer Counters { MapCounters counters; };
layout(std430, binding = 8) writeonly buffer PixelVoxels { uint pixel_voxels[]; };  // slot << 6 | voxel in its block

#include "lib/map/insert_key.glsl"

bool observable(ivec2 pixel, vec4 point, vec3 toward) {
    const uint inclination = imageLoad(slope, pixel).x;
    const float off_m = (imageLoad(depth_m, pixel).x - point.w) * slope_plane_factor(inclination);
    const float tolerance_m = frame.depth_tolerance_m + frame.depth_tolerance_per_m2 * point.w * point.w;
    const float distance_m = length(toward);
    return point.w > 0.0 && inclination != 0u && abs(off_m) <= tolerance_m && distance_m <= frame.max_distance_m &&
           dot(imageLoad(normal, pixel).xyz, toward) >= frame.min_cosine * distance_m;
}

uint touch(vec3 point_m) {
    const ivec3 voxel = ivec3(floor(point_m / frame.grid.voxel_m));
    const uint key = key_of_block(frame.grid, voxel >> int(frame.edge_shift));
    if (key == kEmptyKey) {
        atomicAdd(counters.outside_samples, 1u);
        return kNoSlot;
    }
    const Insertion at = insert_key(frame.grid, key, counters.table_keys < frame.max_table_keys);
    if (at.fresh) new_slots[atomicAdd(counters.new_keys, 1u)] = at.slot;
    if (at.slot == kNoSlot) {
        atomicAdd(counters.refused_samples, 1u);
        return kNoSlot;
    }
    return at.slot << 6 | voxel_number(voxel, frame.edge_shift);
}

void main() {
    const uvec2 item = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(item, frame.visited))) return;
    const ivec2 pixel =
        ivec2(item * frame.stride_px) + ivec2(frame.phase % frame.stride_px, frame.phase / frame.stride_px);
    // Outside the image there is no surface: images read zero there.
    const vec4 point = imageLoad(position_m, pixel);
    uint found = kNoSlot;
    if (observable(pixel, point, camera_center_m(frame.color_camera) - point.xyz)) found = touch(point.xyz);
    pixel_voxels[item.y * frame.visited.x + item.x] = found;
}
