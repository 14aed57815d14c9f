#version 460
#extension GL_GOOGLE_include_directive : require
// What each trial lamp of intensity 1 gives each sample of the surface: its cosine over pi and the squared distance, 0
// where the model stands in the way.
#include "shared/fit_lights.h"
layout(local_size_x = kRecordGroup) in;
layout(std430, binding = 0) readonly buffer Samples { LightSample samples[]; };
layout(std430, binding = 1) readonly buffer Trials { vec4 trials_m[]; };
layout(std430, binding = 2) writeonly buffer Received { float received[]; };
layout(std430, binding = 3) readonly buffer Keys { uvec4 buckets[]; };
layout(std430, binding = 4) readonly buffer Blocks { uint blocks[]; };
layout(std430, binding = 5) readonly buffer Tsdf { uint voxels[]; }
tsdf[kMaxVoxelChunks];
layout(push_constant) uniform Push { TrialParams params; };
#define KEYS(bucket) buckets[bucket]
#define BLOCK(slot) blocks[slot]
#include "lib/block_lookup.glsl"
#include "lib/voxel_chunks.glsl"

const uint kMaxSteps = 512u;
const float kPi = 3.14159265358979;
const float kLiftVox = 4.0;          // above the surface, where the way begins
const float kMostSkippedVox = 16.0;  // of the way, to get there
const float kInsideVox = 0.5;        // a voxel this deep is inside
const float kUnseenStepVox = 2.0;

// Distance to the surface at voxel coordinates, voxels; far where nothing was seen. `block_end` is how far the ray may
// go where there is no block.
float distance_vox(ivec3 voxel) {
    const uint block = find_block(params.grid, voxel >> 3);
    if (block == kNoBlock) return 1e6;
    const ivec3 within = voxel & 7;
    const uint index =
        index_in_chunk(params.grid.chunk_shift, block) * kBlockVoxels + uint(within.z << 6 | within.y << 3 | within.x);
    uint found;
#define LOAD_VOXEL(C) found = tsdf[C].voxels[index]
    WITH_CHUNK(params.grid.chunk_shift, block, LOAD_VOXEL)
    return voxel_weight(found) > 0u ? voxel_sdf(found) * kSdfRangeVox : 1e5;
}

// How far a ray goes on within the block that it is in.
float to_block_end(vec3 at, vec3 inverse_direction) {
    const vec3 first = floor(at * 0.125) * 8.0;
    const vec3 ends = (first + 8.0 * step(vec3(0.0), inverse_direction) - at) * inverse_direction;
    return max(min(min(ends.x, ends.y), ends.z), 0.0) + 0.01;
}

bool is_open(vec3 point_m, vec3 normal, vec3 direction, float distance_m) {
    const float per_m = 1.0 / params.grid.voxel_m;
    const float cosine = dot(direction, normal);
    float gone = min(kLiftVox / cosine, kMostSkippedVox);
    const vec3 start = point_m * per_m + normal * max(kLiftVox - gone * cosine, 0.0);
    const vec3 inverse_direction = 1.0 / mix(direction, vec3(1e-6), lessThan(abs(direction), vec3(1e-6)));
    const float reach = (distance_m - min(kTrialLampM, 0.3 * distance_m)) * per_m;
    for (uint i = 0u; i < kMaxSteps && gone < reach; ++i) {
        const vec3 at = start + direction * gone;
        const float here = distance_vox(ivec3(floor(at)));
        if (here < -kInsideVox) return false;
        gone += here > 5e5 ? to_block_end(at, inverse_direction) : here > 5e4 ? kUnseenStepVox : max(0.9 * here, 1.0);
    }
    return true;
}

void main() {
    const uint item = gl_GlobalInvocationID.x, trial = gl_WorkGroupID.y;
    const LightSample lit = samples[item];
    const vec3 offset_m = trials_m[trial].xyz - lit.point_m.xyz;
    const float distance2 = max(dot(offset_m, offset_m), 1e-6);
    const vec3 direction = offset_m * inversesqrt(distance2);
    const float cosine = dot(direction, lit.normal.xyz);
    float result = 0.0;
    if (lit.point_m.w > 0.0 && cosine > kLeastTrialCosine &&
        is_open(lit.point_m.xyz, lit.normal.xyz, direction, sqrt(distance2))) {
        result = cosine / (kPi * distance2);
    }
    received[trial * kLightSamples + item] = result;
}
