#version 460
#extension GL_GOOGLE_include_directive : require
// What each trial sun gives each sample of the surface: the cosine to its direction, 0 where the model stands in the
// way, or where the ray passes no opening in which pictures show the sky.
#include "lib/records/reflectance.glsl"
#include "shared/lighting/fit_lights.h"
#include "shared/reflectance/far_field.h"
#include "shared/reflectance/surroundings.h"
layout(local_size_x = kTrialGroup, local_size_y = kTrialSamples) in;
layout(std430, binding = 0) readonly buffer Samples { LightSample samples[]; };
layout(std430, binding = 1) readonly buffer Trials { vec4 directions[]; };
layout(std430, binding = 2) writeonly buffer Received { float received[]; };
layout(std430, binding = 3) readonly buffer Surroundings{SURROUNDINGS_MEMBERS};
layout(std430, binding = 4) readonly buffer Keys { uvec4 buckets[]; };
layout(std430, binding = 5) readonly buffer Blocks { uint blocks[]; };
layout(std430, binding = 6) readonly buffer Tsdf { uint voxels[]; }
tsdf[kMaxVoxelChunks];
layout(push_constant) uniform Push { TrialParams params; };
#define KEYS(bucket) buckets[bucket]
#define BLOCK(slot) blocks[slot]
#define VOXEL(C, i) tsdf[C].voxels[i]
#define BLOCKS_IN_USE blocks_in_use
#include "lib/lighting/march_surroundings.glsl"
#include "lighting/trial_way.glsl"

void main() {
    const uint trial = gl_GlobalInvocationID.x, item = gl_GlobalInvocationID.y;
    if (trial >= params.trials) return;
    const LightSample lit = samples[item];
    const vec3 direction = directions[trial].xyz;
    grid = params.grid;
    const float cosine = dot(direction, lit.normal.xyz);
    float result = 0.0;
    const float reach = to_ball_end(lit.point_m.xyz / grid.voxel_m, direction, params.ball_m);
    if (lit.point_m.w > 0.0 && cosine > kLeastTrialCosine && passes_sky(lit.point_m.xyz, lit.normal.xyz, direction) &&
        is_open(lit, direction, cosine, reach)) {
        result = cosine;
    }
    received[trial * kLightSamples + item] = result;
}
