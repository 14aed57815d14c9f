// Body of the ray casting shaders. The includer declares the view's grid of blocks and the map's distances and how to
// load them:
//   CELL(i)         uint, the block id in a cell of the view grid
//   VOXEL(C, i)     uint, voxel i of the literal chunk C
// The march reads nearest voxels; interpolation happens once, at the hit.
#include "lib/camera/camera.glsl"
#include "lib/camera/view_grid.glsl"
#include "lib/map/voxel_chunks.glsl"
#include "lib/map/voxel_map.glsl"
#include "shared/fusion/raycast.h"

layout(local_size_x = kRaycastGroupX, local_size_y = kRaycastGroupY) in;
layout(std140, binding = 0) uniform View { ViewParams view; };
layout(std430, binding = 1) readonly buffer Tiles { TileRange tiles[]; };
layout(binding = 2, rgba32f) uniform writeonly image2D
    position_m;  // world; w: depth along the optical axis, 0 where nothing was hit
layout(binding = 3,
       rgba16f) uniform writeonly image2D normal;  // world, unit length, towards free space; 0 where nothing was hit

// Copies from the uniform buffer, whose loads software devices do not hoist out of loops.
ivec3 grid_low;
uvec3 grid_size;
uint chunk_shift;

// The voxel at voxel coordinates; 0 (weight 0) where there is no block.
uint load_voxel(ivec3 coordinates) {
    const uint cell = view_grid_cell(grid_low, grid_size, coordinates >> 3);
    const uint found = CELL(cell == kOutsideGrid ? 0u : cell);
    const bool have = cell != kOutsideGrid && found != kNoBlock;
    const uint block = have ? found : 0u;
    const ivec3 within = coordinates & 7;
    const uint index =
        index_in_chunk(chunk_shift, block) * kBlockVoxels + uint(within.z << 6 | within.y << 3 | within.x);
    uint voxel;
#define LOAD_VOXEL(C) voxel = VOXEL(C, index)
    WITH_CHUNK(chunk_shift, block, LOAD_VOXEL)
    return have ? voxel : 0u;
}

struct Cell {
    bool complete;  // all eight corners have been seen
    float sdf;
    vec3 gradient;       // of the trilinear interpolant, per voxel
    vec3 seen_gradient;  // the same, the mean of the edges with two seen corners; 0 along an axis without one
};

// The trilinear interpolant of the eight voxels around a point (voxel units, voxel centres at integers).
Cell interpolate(vec3 point_vox) {
    const ivec3 low = ivec3(floor(point_vox));
    const vec3 t = point_vox - vec3(low);
    float f[8], seen[8];
    uint least_weight = 0xffffu;
    [[unroll]] for (int i = 0; i < 8; ++i) {
        const uint voxel = load_voxel(low + ivec3(i & 1, i >> 1 & 1, i >> 2));
        least_weight = min(least_weight, voxel_weight(voxel));
        f[i] = voxel_sdf(voxel);
        seen[i] = min(float(voxel_weight(voxel)), 1.0);
    }
    vec3 slopes = vec3(0.0), edges = vec3(0.0);
    [[unroll]] for (int i = 0; i < 8; ++i) {
        [[unroll]] for (int axis = 0; axis < 3; ++axis) {
            const int next = i | 1 << axis;
            const float both = next != i ? seen[i] * seen[next] : 0.0;
            slopes[axis] += both * (f[next] - f[i]);
            edges[axis] += both;
        }
    }
    const vec4 at_x = mix(vec4(f[0], f[2], f[4], f[6]), vec4(f[1], f[3], f[5], f[7]), t.x);
    const vec4 slope_x = vec4(f[1], f[3], f[5], f[7]) - vec4(f[0], f[2], f[4], f[6]);
    const vec2 at_y = mix(at_x.xz, at_x.yw, t.y);
    const vec2 slope_y = at_x.yw - at_x.xz;
    const vec2 slope_xy = mix(slope_x.xz, slope_x.yw, t.y);
    Cell cell;
    cell.complete = least_weight > 0u;
    cell.sdf = mix(at_y.x, at_y.y, t.z);
    cell.gradient = vec3(mix(slope_xy.x, slope_xy.y, t.z), mix(slope_y.x, slope_y.y, t.z), at_y.y - at_y.x);
    cell.seen_gradient = slopes / max(edges, 1.0);
    return cell;
}

// The first voxel inside on a ray.
struct Bracket {
    bool inside;        // there is one
    bool seen_outside;  // and the last one before it is outside; else nobody saw what is before it
    float outside_depth;
    float inside_depth;
    float outside_share;  // where between them the distances, taken as linear, are zero
    float inside_sdf;
};

// Marches from `depth` on to the first voxel inside. A short loop without branches: on software devices a divergent
// branch costs as much as its longest path.
Bracket march(vec3 origin, vec3 direction, float depth, float far, float depth_per_vox) {
    float outside_depth = depth;
    float here = 1.0, outside = 1.0;  // in units of kSdfRangeVox; 1 stands for unknown space
    bool seen_outside = false;
    bool marching = true;
    for (uint i = 0u; marching && i < kMaxRaySteps; ++i) {
        const uint voxel = load_voxel(ivec3(floor(origin + direction * depth)));
        const bool seen = voxel_weight(voxel) > 0u;
        here = seen ? voxel_sdf(voxel) : 1.0;
        const bool inside = here <= 0.0;
        const float step_vox = seen ? max(here * (0.9 * kSdfRangeVox), 1.0) : kUnknownStepVox;
        outside_depth = inside ? outside_depth : depth;
        outside = inside ? outside : here;
        seen_outside = inside ? seen_outside : seen;
        depth = inside ? depth : depth + step_vox * depth_per_vox;
        marching = !inside && depth < far;
    }
    return Bracket(here <= 0.0, seen_outside, outside_depth, depth, outside / (outside - here), here);
}

void main() {
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(view.camera.extent)))) return;
    grid_low = view.grid_low.xyz;
    grid_size = view.grid_size.xyz;
    chunk_shift = view.grid.chunk_shift;
    const TileRange range = tiles[uint(pixel.y) / kTileEdge * view.tiles.x + uint(pixel.x) / kTileEdge];
    const float far = min(uintBitsToFloat(~range.far_bits_inverted), view.far_m);
    // The ray in voxel units, by depth along the optical axis.
    const float inverse_voxel = 1.0 / view.grid.voxel_m;
    const vec3 in_camera = unproject(view.camera, vec2(pixel));
    const vec3 origin = camera_center_m(view.camera) * inverse_voxel;
    const vec3 direction = to_world_direction(view.camera, in_camera) * inverse_voxel;
    const float depth_per_vox = view.grid.voxel_m / length(in_camera);

    float depth = range.near_bits == 0xffffffffu ? far + 1.0 : max(uintBitsToFloat(range.near_bits), view.near_m);
    vec4 hit_position = vec4(0.0);
    vec4 hit_normal = vec4(0.0);
    bool marching = true, from_unknown = false;
    float estimate = 0.0, unknown_sdf = 0.0;
    for (uint attempt = 0u; attempt < kMaxAttempts && depth < far; ++attempt) {
        if (marching) {
            const Bracket bracket = march(origin, direction, depth, far, depth_per_vox);
            if (!bracket.inside) break;
            const bool from_inside = attempt > 0u && bracket.inside_depth <= depth;
            depth = bracket.inside_depth;
            estimate = bracket.seen_outside ? mix(bracket.outside_depth, depth, bracket.outside_share) : depth;
            from_unknown = !bracket.seen_outside && !from_inside;
            unknown_sdf = bracket.inside_sdf;
        }
        // What is behind the first voxel inside has been seen sooner than what is before it.
        const float looked_at = from_unknown ? estimate + depth_per_vox : estimate;
        const Cell cell = interpolate(origin + direction * looked_at - 0.5);
        // From unknown space into the inside: the back of a surface, or one whose front is missing, as at the border of
        // the only picture of it. The latter faces the ray, and lies within the step that led through unknown space.
        if (from_unknown) {
            const float facing = -dot(cell.seen_gradient, direction) * depth_per_vox * kSdfRangeVox;
            const float before_vox = -unknown_sdf * kSdfRangeVox / max(facing, kLeastFacing);
            if (facing >= kLeastFacing && before_vox <= kUnknownStepVox) {
                const float accepted = estimate - before_vox * depth_per_vox;
                hit_position = vec4((origin + direction * accepted) * view.grid.voxel_m, accepted);
            }
            break;
        }
        // A Newton step along the ray. Nearest voxels are off by up to a voxel across the surface, and by more along a
        // ray that grazes it; such a ray can even pass through a voxel whose centre is inside and yet stay outside.
        const float slope = dot(cell.gradient, direction);
        const float hit = estimate - cell.sdf / min(slope, -1e-6);
        const float moved_vox = abs(hit - estimate) / depth_per_vox;
        const bool passes = moved_vox > kLongestStepVox;
        if (cell.complete && moved_vox > kAcceptedStepVox && attempt + 1u < kMaxAttempts) {
            // A ray that passes by goes on from the next voxel, which may be inside, too.
            marching = passes;
            depth = marching ? depth + depth_per_vox : depth;
            estimate = hit;
            continue;
        }
        // Where the cell has corners that nobody saw, the nearest voxels have to do; so they have where a ray has gone
        // along a surface, less than a voxel from it, for so long that its attempts are over.
        const float accepted = cell.complete && !passes ? hit : estimate;
        hit_position = vec4((origin + direction * accepted) * view.grid.voxel_m, accepted);
        const float steepness = length(cell.gradient);
        if (cell.complete && steepness > 0.0) hit_normal = vec4(cell.gradient / steepness, 0.0);
        break;
    }
    imageStore(position_m, pixel, hit_position);
    imageStore(normal, pixel, hit_normal);
}
