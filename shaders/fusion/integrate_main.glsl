// Body of the integration shaders. One workgroup per visible block; an invocation takes four voxels along x at a time
// (one 16-byte load and store). Curless and Levoy's running average of the distance from the plane through the reading:
// the projective distance d - z would depend on the viewing direction, and blur what several views see. Where
// PATINA_MARK_SURFACE is 1, marks the voxels that take colour and lists the blocks whose turn it is.
#include "lib/camera/camera.glsl"
#include "lib/camera/pixel_row.glsl"
#include "lib/map/slope.glsl"
#include "lib/map/voxel_chunks.glsl"
#include "lib/map/voxel_map.glsl"
#include "shared/fusion/allocate_blocks.h"
#include "shared/fusion/integrate.h"

layout(local_size_x = kIntegrateGroup) in;
layout(std430, binding = 0) readonly buffer Visible { uint visible[]; };
layout(std430, binding = 1) readonly buffer BlockKeys { uint block_keys[]; };
layout(std140, binding = 2) uniform Fusion { FusionParams fusion; };
layout(binding = 3, r32f) uniform readonly image2D depth_m;
layout(binding = 4, r32ui) uniform readonly uimage2D slope;
layout(std430, binding = 5) buffer Tsdf { uvec4 quads[]; }
tsdf[kMaxVoxelChunks];
#if PATINA_MARK_SURFACE
layout(std430, binding = 6) writeonly buffer NearSurface { uint near_surface[]; };
layout(std430, binding = 7) buffer ColorBlocks { uint color_blocks[]; };
layout(std430, binding = 8) buffer ColorArguments { uint color_arguments[]; };

shared uint group_marks;
#endif

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

const uint kUnsettled = 1u << 31;  // a mark: some voxel near the surface has few samples

// Four voxels along x, from `voxel` on: quad `quad` of the block's chunk. Returns bit i if voxel i lies near the
// surface, and kUnsettled if one of these has few samples.
uint integrate_quad(uint block, uint quad, ivec3 voxel) {
    const vec3 world_m = (vec3(voxel) + 0.5) * fusion.grid.voxel_m;
    const PixelRow row = pixel_row(fusion.depth_camera, world_m, fusion.grid.voxel_m);
    Sample seen[4];
    [[unroll]] for (int i = 0; i < 4; ++i) seen[i] =
        sample_depth(pixel_of(row, i), row.first.z + float(i) * row.step.z);
#define LOAD_TSDF(C) voxels = tsdf[C].quads[quad]
#define STORE_TSDF(C) tsdf[C].quads[quad] = voxels
    uvec4 voxels;
    WITH_CHUNK(fusion.grid.chunk_shift, block, LOAD_TSDF)
    [[unroll]] for (int i = 0; i < 4; ++i) voxels[i] = update_voxel(voxels[i], seen[i]);
    WITH_CHUNK(fusion.grid.chunk_shift, block, STORE_TSDF)

    uint marks = 0u;
    [[unroll]] for (int i = 0; i < 4; ++i) {
        const bool near = seen[i].valid && abs(seen[i].signed_m) <= fusion.color_band_m;
        const uint unsettled = float(voxel_weight(voxels[i])) < fusion.settled_weight ? kUnsettled : 0u;
        marks |= near ? 1u << i | unsettled : 0u;
    }
    return marks;
}

#if PATINA_MARK_SURFACE
// Most blocks show a surface that is settled, whose colours remember many frames: they take colour by turns, others in
// every frame.
void list_color_block(uint item, uint key) {
    const uint diagonal = (key & 0x7ffu) + (key >> 11 & 0x3ffu) + (key >> 21);  // neighbours differ by one
    const bool turn = (diagonal + fusion.color_frame) % fusion.settled_color_every == 0u;
    if (group_marks == 0u || !(turn || (group_marks & kUnsettled) != 0u)) return;
    const uint listed = atomicAdd(color_blocks[0], 1u);
    color_blocks[1u + listed] = item;
    GROW_ARGUMENTS(color_arguments, listed)
}
#endif

void main() {
    const uint item = group_item(gl_WorkGroupID);
    if (item >= visible[0]) return;
    const uint block = visible[1u + item];
    const uint key = block_keys[block];
    const ivec3 corner = block_of_key(fusion.grid, key) * int(kBlockEdge);
    const uint first_quad = index_in_chunk(fusion.grid.chunk_shift, block) * (kBlockVoxels / 4u);
    uint near = 0u, unsettled = 0u;
    // Few invocations with several quads each: on software devices every eight invocations of a group cost as much to
    // start as the work on a quad.
    [[unroll]] for (uint i = 0u; i < kQuadsPerInvocation; ++i) {
        const uint quad = i * kIntegrateGroup + gl_LocalInvocationIndex;
        const ivec3 within = ivec3((quad & 1u) * 4u, quad >> 1 & 7u, quad >> 4);
        const uint marks = integrate_quad(block, first_quad + quad, corner + within);
        near |= (marks & ~kUnsettled) << 4u * i;
        unsettled |= marks & kUnsettled;
    }
#if PATINA_MARK_SURFACE
    near_surface[item * kIntegrateGroup + gl_LocalInvocationIndex] = near;
    if (gl_LocalInvocationIndex == 0u) group_marks = 0u;
    barrier();
    if (near != 0u) atomicOr(group_marks, near | unsettled);
    barrier();
    if (gl_LocalInvocationIndex == 0u) list_color_block(item, key);
#endif
}
