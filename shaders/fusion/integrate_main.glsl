// Body of the integration shaders: TSDF, and colour where PATINA_WITH_COLOR is 1. One workgroup per visible block, four voxels along
// x per invocation (one 16-byte load and store). Curless and Levoy's running average of the distance from the plane through the
// reading: the projective distance d - z would depend on the viewing direction, and blur what several views see.
#include "lib/camera.glsl"
#include "lib/slope.glsl"
#include "lib/voxel_chunks.glsl"
#include "lib/voxel_map.glsl"
#include "shared/allocate_blocks.h"
#include "shared/integrate.h"

layout(local_size_x = kIntegrateGroup) in;
layout(std430, binding = 0) readonly buffer Visible { uint visible[]; };
layout(std430, binding = 1) readonly buffer BlockKeys { uint block_keys[]; };
layout(std140, binding = 2) uniform Fusion { FusionParams fusion; };
layout(binding = 3, r32f) uniform readonly image2D depth_m;
layout(binding = 4, r32ui) uniform readonly uimage2D slope;
layout(std430, binding = 5) buffer Tsdf { uvec4 quads[]; } tsdf[kMaxTsdfChunks];
#if PATINA_WITH_COLOR
layout(binding = 6, rgba16f) uniform readonly image2D color_linear;
layout(std430, binding = 7) buffer Color { uvec2 voxels[]; } color[kMaxColorChunks];
#endif

struct Sample {
    bool valid;
    float signed_m;  // distance from the reading's tangent plane, positive in front of the surface
    float weight;    // whole; kWeightOne for a surface that faces the camera; less for an inclined one, whose depth is noisier
};

Sample sample_depth(vec3 point_m) {
    const vec2 pixel = project(fusion.depth_camera, vec3(point_m.xy, max(point_m.z, 1e-3)));
    const vec2 nearest = floor(pixel + 0.5);
    const ivec2 inside = clamp(ivec2(nearest), ivec2(0), ivec2(fusion.depth_camera.extent) - 1);
    const float reading = imageLoad(depth_m, inside).x;
    const uint inclination = imageLoad(slope, inside).x;
    const float plane_factor = slope_plane_factor(inclination);
    const float depth = reading + dot(slope_depth_per_px(inclination), pixel - nearest);
    // Behind the surface a reading speaks for a stretch of the ray as long as the truncation band, however inclined: at a limb
    // the ray soon leaves the object again.
    const float along_m = depth - point_m.z;
    const float truncation = fusion.truncation_m + fusion.truncation_slope * reading;
    Sample result;
    result.signed_m = min(along_m * plane_factor, truncation);
    // Behind the surface a reading knows less and less: beyond an edge or a limb there is free space that other views see.
    const float trust = clamp(1.0 + along_m / truncation, 0.0, 1.0);
    // Whole numbers add up without loss, and so in any order.
    result.weight = max(floor(float(kWeightOne) * plane_factor * trust * trust + 0.5), 1.0);
    result.valid = ivec2(nearest) == inside && point_m.z > 1e-3 && reading > 0.0 && reading <= fusion.max_depth_m && plane_factor > 0.0 &&
                   along_m >= -truncation;
    return result;
}

uint update_voxel(uint voxel, Sample seen) {
    const float weight = float(voxel_weight(voxel));
    const float scale = 1.0 / (kSdfRangeVox * fusion.grid.voxel_m);
    const float sum = weight + seen.weight;
    const float sdf = (voxel_sdf(voxel) * weight + seen.signed_m * scale * seen.weight) / sum;
    const uint updated = pack_voxel(sdf, uint(min(sum, fusion.max_weight)));
    return seen.valid ? updated : voxel;
}

#if PATINA_WITH_COLOR
uvec2 update_color(uvec2 packed, vec3 point_m) {
    const vec2 pixel = project(fusion.color_camera, vec3(point_m.xy, max(point_m.z, 1e-3)));
    const ivec2 nearest = ivec2(floor(pixel + 0.5));
    const ivec2 inside = clamp(nearest, ivec2(0), ivec2(fusion.color_camera.extent) - 1);
    const vec4 seen = imageLoad(color_linear, inside);
    if (nearest != inside || point_m.z <= 1e-3 || seen.a == 0.0) return packed;
    const float weight = float(color_weight(packed));
    const vec3 mean = (voxel_color(packed) * weight + seen.rgb) / (weight + 1.0);
    return pack_color(mean, uint(min(weight + 1.0, fusion.max_color_weight)));
}
#endif

void main() {
    const uint item = group_item(gl_WorkGroupID);
    if (item >= visible[0]) return;
    const uint block = visible[1u + item];
    const uint lane = gl_LocalInvocationIndex;
    const ivec3 corner = block_of_key(fusion.grid, block_keys[block]) * int(kBlockEdge) +
                         ivec3((lane & 1u) * 4u, lane >> 1 & 7u, lane >> 4);
    const vec3 world = (vec3(corner) + 0.5) * fusion.grid.voxel_m;
    const vec3 point = to_camera(fusion.depth_camera, world);
    const vec3 step_m = fusion.depth_camera.camera_from_world[0].xyz * fusion.grid.voxel_m;
    const uint quad = index_in_tsdf_chunk(fusion.grid, block) * (kBlockVoxels / 4u) + lane;

    Sample seen[4];
    [[unroll]] for (int i = 0; i < 4; ++i) seen[i] = sample_depth(point + float(i) * step_m);
#define LOAD_TSDF(C) voxels = tsdf[C].quads[quad]
#define STORE_TSDF(C) tsdf[C].quads[quad] = voxels
    uvec4 voxels;
    WITH_TSDF_CHUNK(fusion.grid, block, LOAD_TSDF)
    [[unroll]] for (int i = 0; i < 4; ++i) voxels[i] = update_voxel(voxels[i], seen[i]);
    WITH_TSDF_CHUNK(fusion.grid, block, STORE_TSDF)

#if PATINA_WITH_COLOR
    bvec4 near;
    [[unroll]] for (int i = 0; i < 4; ++i) near[i] = seen[i].valid && abs(seen[i].signed_m) <= fusion.color_band_m;
    if (!any(near)) return;
    const vec3 color_point = to_camera(fusion.color_camera, world);
    const vec3 color_step_m = fusion.color_camera.camera_from_world[0].xyz * fusion.grid.voxel_m;
#define LOAD_COLOR(C) packed = color[C].voxels[voxel]
#define STORE_COLOR(C) color[C].voxels[voxel] = packed
    [[unroll]] for (int i = 0; i < 4; ++i) {
        if (near[i]) {
            const uint voxel = index_in_color_chunk(fusion.grid, block) * kBlockVoxels + 4u * lane + uint(i);
            uvec2 packed;
            WITH_COLOR_CHUNK(fusion.grid, block, LOAD_COLOR)
            packed = update_color(packed, color_point + float(i) * color_step_m);
            WITH_COLOR_CHUNK(fusion.grid, block, STORE_COLOR)
        }
    }
#endif
}
