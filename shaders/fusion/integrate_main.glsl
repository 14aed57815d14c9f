// Body of the integration shaders: TSDF, and colour where PATINA_WITH_COLOR is 1. One workgroup per visible block; an
// invocation takes four voxels along x at a time (one 16-byte load and store). Curless and Levoy's running average of
// the distance from the plane through the reading: the projective distance d - z would depend on the viewing direction,
// and blur what several views see.
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
layout(std430, binding = 5) buffer Tsdf { uvec4 quads[]; }
tsdf[kMaxVoxelChunks];
#if PATINA_WITH_COLOR
layout(binding = 6, rgba16f) uniform readonly image2D color_linear;
layout(std430, binding = 7) buffer Color { uvec4 quads[]; }
color[kMaxVoxelChunks];
#endif

// Homogeneous pixel coordinates of four voxels along x: they are linear in the voxel's index.
struct Row {
    vec3 first;
    vec3 step;
};

Row row_of(Camera camera, vec3 world_m) {
    const vec4 k = camera.focal_center_px;
    const mat3 pixel_from_camera = mat3(k.x, 0.0, 0.0, 0.0, k.y, 0.0, k.z, k.w, 1.0);
    return Row(pixel_from_camera * to_camera(camera, world_m),
               pixel_from_camera * (camera.camera_from_world[0].xyz * fusion.grid.voxel_m));
}

// The pixel of voxel i, far outside every image where it is not before the camera. Images read zero outside.
vec2 pixel_of(Row row, int i) {
    const vec3 at = row.first + float(i) * row.step;
    return at.z > kNearestDepth ? at.xy * (1.0 / at.z) : vec2(-1e6);
}

const float kFreeShare = 0.25;  // of the weight of free space beside an edge

struct Sample {
    bool valid;
    float signed_m;  // distance from the reading's tangent plane, positive in front of the surface
    float weight;    // whole; kWeightOne for a surface that faces the camera; less for an inclined one, whose depth is
                     // noisier
};

// The nearest reading to a point that appears at `pixel`, `z` metres before the camera.
Sample sample_depth(vec2 pixel, float z) {
    const vec2 nearest = floor(pixel + 0.5);
    const float reading = imageLoad(depth_m, ivec2(nearest)).x;
    const uint inclination = imageLoad(slope, ivec2(nearest)).x;
    const float plane_factor = slope_plane_factor(inclination);
    // Behind the surface a reading speaks for a stretch of the ray as long as the truncation band, however inclined: at
    // a limb the ray soon leaves the object again. And it knows less and less: beyond an edge there is free space that
    // other views see.
    const float along_m = reading + dot(slope_depth_per_px(inclination), pixel - nearest) - z;
    const float truncation = fusion.truncation_m + fusion.truncation_slope * reading;
    const float trust = clamp(1.0 + along_m / truncation, 0.0, 1.0);
    // Beside an edge free space says less than how far the reading is: the nearer surface ends within about a pixel.
    // Without this bound, and with its full weight, one pixel's free space outvotes many views of the rim, and wears it
    // away.
    const float pixel_m = z / fusion.depth_camera.focal_center_px.x;
    const float most_m = slope_beside_edge(inclination) ? min(pixel_m, truncation) : truncation;
    Sample result;
    result.signed_m = min(along_m * plane_factor, most_m);
    // Whole numbers add up without loss, and so in any order.
    const float share = slope_beside_edge(inclination) && along_m > pixel_m ? kFreeShare : 1.0;
    result.weight = max(floor(float(kWeightOne) * share * plane_factor * trust * sqrt(trust) + 0.5), 1.0);
    result.valid = inclination != 0u && reading > 0.0 && reading <= fusion.max_depth_m && along_m >= -truncation;
    return result;
}

uint update_voxel(uint voxel, Sample seen) {
    const float weight = float(voxel_weight(voxel));
    const float sum = weight + seen.weight;
    const float seen_sdf = seen.signed_m * fusion.inverse_sdf_range;
    const float sdf = mix(voxel_sdf(voxel), seen_sdf, seen.weight / sum);
    return seen.valid ? pack_voxel(sdf, uint(min(sum, fusion.max_weight))) : voxel;
}

#if PATINA_WITH_COLOR
// The mean of what a voxel's colour was and what the colour camera sees at its place, by the weight of its distance.
uint update_color(uint color, uint voxel, vec2 pixel, uint dither) {
    const vec4 seen = imageLoad(color_linear, ivec2(floor(pixel + 0.5)));
    const float weight = min(float(voxel_weight(voxel)), fusion.max_color_weight);
    const float share = color == 0u ? 1.0 : min(float(kWeightOne) / weight, 1.0);
    return seen.a > 0.0 ? pack_color(mix(voxel_color(color), seen.rgb, share), dither) : color;
}
#endif

// Four voxels along x, from `voxel` on: quad `quad` of the block's chunk.
void integrate_quad(uint block, uint quad, ivec3 voxel, uint dither) {
    const vec3 world_m = (vec3(voxel) + 0.5) * fusion.grid.voxel_m;
    const Row row = row_of(fusion.depth_camera, world_m);
    Sample seen[4];
    [[unroll]] for (int i = 0; i < 4; ++i) seen[i] =
        sample_depth(pixel_of(row, i), row.first.z + float(i) * row.step.z);
#define LOAD_TSDF(C) voxels = tsdf[C].quads[quad]
#define STORE_TSDF(C) tsdf[C].quads[quad] = voxels
    uvec4 voxels;
    WITH_CHUNK(fusion.grid.chunk_shift, block, LOAD_TSDF)
    [[unroll]] for (int i = 0; i < 4; ++i) voxels[i] = update_voxel(voxels[i], seen[i]);
    WITH_CHUNK(fusion.grid.chunk_shift, block, STORE_TSDF)

#if PATINA_WITH_COLOR
    bvec4 near;
    [[unroll]] for (int i = 0; i < 4; ++i) near[i] = seen[i].valid && abs(seen[i].signed_m) <= fusion.color_band_m;
    if (!any(near)) return;
    const Row color_row = row_of(fusion.color_camera, world_m);
#define LOAD_COLOR(C) colors = color[C].quads[quad]
#define STORE_COLOR(C) color[C].quads[quad] = colors
    uvec4 colors;
    WITH_CHUNK(fusion.grid.chunk_shift, block, LOAD_COLOR)
    [[unroll]] for (int i = 0; i < 4; ++i) {
        const uint updated = update_color(colors[i], voxels[i], pixel_of(color_row, i), hash_of_key(dither + uint(i)));
        colors[i] = near[i] ? updated : colors[i];
    }
    WITH_CHUNK(fusion.grid.chunk_shift, block, STORE_COLOR)
#endif
}

void main() {
    const uint item = group_item(gl_WorkGroupID);
    if (item >= visible[0]) return;
    const uint block = visible[1u + item];
    const uint key = block_keys[block];
    const ivec3 corner = block_of_key(fusion.grid, key) * int(kBlockEdge);
    const uint first_quad = index_in_chunk(fusion.grid.chunk_shift, block) * (kBlockVoxels / 4u);
    const uint dither = hash_of_key(key ^ fusion.frame_index * 0x9e3779b9u);
    // Few invocations with several quads each: on software devices every eight invocations of a group cost as much to
    // start as the work on a quad.
    [[unroll]] for (uint i = 0u; i < kQuadsPerInvocation; ++i) {
        const uint quad = i * kIntegrateGroup + gl_LocalInvocationIndex;
        const ivec3 within = ivec3((quad & 1u) * 4u, quad >> 1 & 7u, quad >> 4);
        integrate_quad(block, first_quad + quad, corner + within, dither + quad * 4u);
    }
}
