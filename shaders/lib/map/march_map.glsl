// Marches rays through the voxel map, on nearest voxels. Space that was never seen is open. The includer declares the
// map's table and distances and defines, before it includes this,
//   KEYS(bucket)    uvec4, the keys of a bucket
//   BLOCK(slot)     uint, the block id of a table slot
//   VOXEL(C, i)     uint, voxel i of the literal chunk C
// and, so that rays cross what is empty fast, where passes/reflectance/mark_blocks.h has marked what is not,
//   BLOCKS_IN_USE   an Occupancy (shared/reflectance/occupancy.h), member of a buffer
// and sets `grid` before it marches.
#ifndef PATINA_LIB_MARCH_MAP_GLSL
#define PATINA_LIB_MARCH_MAP_GLSL
#include "lib/map/block_lookup.glsl"
#include "lib/map/occupancy.glsl"
#include "lib/map/voxel_chunks.glsl"

const uint kMaxSteps = 1024u;
const float kInsideVox = 0.5;       // a voxel this deep is inside, whatever the noise of a nearest voxel
const float kMetVox = 0.5;          // so near is a surface met
const float kUnknownStepVox = 2.0;  // through unseen voxels of a block

// A copy of the voxel map's, whose loads software devices do not hoist out of loops.
VoxelGrid grid;

// The place within its chunk of the voxel at voxel coordinates; `block` is its block.
uint index_of_voxel(uint block, ivec3 coordinates) {
    const ivec3 within = coordinates & 7;
    return index_in_chunk(grid.chunk_shift, block) * kBlockVoxels + uint(within.z << 6 | within.y << 3 | within.x);
}

// The voxel there.
uint load_voxel(uint block, ivec3 coordinates) {
    const uint index = index_of_voxel(block, coordinates);
    uint voxel;
#define LOAD_VOXEL(C) voxel = VOXEL(C, index)
    WITH_CHUNK(grid.chunk_shift, block, LOAD_VOXEL)
    return voxel;
}

// Where a ray (voxels) that starts in a ball (metres) leaves it: the distance from its start.
float to_ball_end(vec3 start, vec3 direction, vec4 ball_m) {
    const vec3 from_center = start - ball_m.xyz / grid.voxel_m;
    const float radius = ball_m.w / grid.voxel_m;
    const float along = dot(from_center, direction);
    const float rest = along * along + radius * radius - dot(from_center, from_center);
    return max(sqrt(max(rest, 0.0)) - along, 0.0);
}

// How far a ray goes on within the cube that it is in, of `edge` voxels.
float to_cube_end(ivec3 cube, float edge, vec3 at, vec3 inverse_direction) {
    const vec3 ends = (vec3(cube) * edge + edge * step(vec3(0.0), inverse_direction) - at) * inverse_direction;
    return max(min(min(ends.x, ends.y), ends.z), 0.0) + 0.01;
}

#ifdef BLOCKS_IN_USE
// Where a ray is once it has crossed the largest empty cube that it is in, if any.
float cross_gap(vec3 start, vec3 direction, vec3 inverse_direction, float gone) {
    const vec3 at = start + direction * gone;
    const ivec3 block = ivec3(floor(at)) >> 3;
    const int cube = EMPTY_CUBE(BLOCKS_IN_USE, block), n = max(cube, 0);
    return gone + (cube < 0 ? 0.0 : to_cube_end(block >> n, float(int(kBlockEdge) << n), at, inverse_direction));
}
#endif

// Twice that: a block costs more to look up than a cube to cross. (A loop to the next block will not do: on
// lavapipe 22.3 the loop around it then ends too soon.)
float cross_gaps(vec3 start, vec3 direction, vec3 inverse_direction, float gone) {
#ifdef BLOCKS_IN_USE
    const float first = cross_gap(start, direction, inverse_direction, gone);
    return cross_gap(start, direction, inverse_direction, first);
#else
    return gone;
#endif
}

vec3 inverse_of(vec3 direction) { return 1.0 / mix(direction, vec3(1e-6), lessThan(abs(direction), vec3(1e-6))); }

// What a ray finds at a point of its way.
struct Look {
    float here_vox;  // how far the surface is; 1e6 in a voxel that was not observed
    float step_vox;  // how far on nothing can be missed
};

Look look_at(vec3 at, vec3 inverse_direction) {
    const ivec3 voxel = ivec3(floor(at));
    const uint block = find_block(grid, voxel >> 3);
    const bool have = block != kNoBlock;
    const uint loaded = load_voxel(have ? block : 0u, voxel);
    const uint found = have ? loaded : 0u;
    const bool seen = voxel_weight(found) > 0u;
    const float here = seen ? voxel_sdf(found) * kSdfRangeVox : 1e6;
    const float inside_block = seen ? max(0.9 * here, 1.0) : kUnknownStepVox;
    return Look(here, have ? inside_block : to_cube_end(voxel >> 3, float(kBlockEdge), at, inverse_direction));
}

struct Passage {
    bool open;
    bool uncertain;  // it passes a surface, on either side, so near that another point of the voxel may see otherwise
};

// Along a ray from `gone` to `reach` (voxels), which begins `lift` above a surface and leaves it with `slope`.
Passage march(vec3 start, vec3 direction, float gone, float reach, float slope, float lift, float graze_vox) {
    const vec3 inverse_direction = inverse_of(direction);
    float deepest = 1e6;
    bool grazed = false;
    for (uint i = 0u; i < kMaxSteps && gone < reach && deepest > -graze_vox; ++i) {
        const Look look = look_at(start + direction * gone, inverse_direction);
        deepest = min(deepest, look.here_vox);
        // The surface itself is this far.
        grazed = grazed || look.here_vox < min(graze_vox, 0.5 * (lift + gone * slope));
        gone = cross_gaps(start, direction, inverse_direction, gone + look.step_vox);
    }
    const bool open = deepest > -kInsideVox;
    return Passage(open, grazed && deepest > -graze_vox);
}

// Where a ray first meets a surface on its way from `gone` to `reach`, from its start (voxels); -1 where it meets none.
float find_hit(vec3 start, vec3 direction, float gone, float reach) {
    const vec3 inverse_direction = inverse_of(direction);
    bool met = false;
    for (uint i = 0u; i < kMaxSteps && gone < reach && !met; ++i) {
        const Look look = look_at(start + direction * gone, inverse_direction);
        met = look.here_vox < kMetVox;
        gone = met ? gone : cross_gaps(start, direction, inverse_direction, gone + look.step_vox);
    }
    return met ? gone : -1.0;
}

#endif
