#version 460
#extension GL_GOOGLE_include_directive : require
// What each trial lamp of intensity 1 gives each sample of the surface: its cosine over pi and the squared distance, 0
// where the model stands in the way.
#include "lib/math/pi.glsl"
#include "shared/lighting/fit_lights.h"
#include "shared/reflectance/far_field.h"
#include "shared/reflectance/surroundings.h"

layout(local_size_x = kTrialGroup, local_size_y = kTrialSamples) in;
layout(std430, binding = 0) readonly buffer Samples { LightSample samples[]; };
layout(std430, binding = 1) readonly buffer Trials { vec4 trials_m[]; };
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
#include "lighting/trial_way.glsl"

void main() {
    const uint trial = gl_GlobalInvocationID.x, item = gl_GlobalInvocationID.y;
    if (trial >= params.trials) return;
    const LightSample lit = samples[item];
    grid = params.grid;
    const vec3 offset_m = trials_m[trial].xyz - lit.point_m.xyz;
    const float distance2 = max(dot(offset_m, offset_m), 1e-6);
    const vec3 direction = offset_m * inversesqrt(distance2);
    const float cosine = dot(direction, lit.normal.xyz);
    float result = 0.0;
    const float distance_m = sqrt(distance2);
    const float reach = (distance_m - min(kTrialLampM, 0.3 * distance_m)) / grid.voxel_m;
    if (lit.point_m.w > 0.0 && cosine > kLeastTrialCosine && is_open(lit, direction, cosine, reach)) {
        result = cosine / (kPi * distance2);
    }
    received[trial * kLightSamples + item] = result;
}
