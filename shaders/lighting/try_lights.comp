#version 460
#extension GL_GOOGLE_include_directive : require
// What each trial lamp of intensity 1 gives each sample of the surface: its cosine over pi and the squared distance, 0
// where the model stands in the way.
#include "lib/math/pi.glsl"
#include "shared/lighting/fit_lights.h"
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
#define VOXEL(C, i) tsdf[C].voxels[i]
#include "lib/map/march_map.glsl"

const float kLiftVox = 4.0;          // above the surface, where the way begins
const float kMostSkippedVox = 16.0;  // of the way, to get there

bool is_open(vec3 point_m, vec3 normal, vec3 direction, float distance_m) {
    const float per_m = 1.0 / grid.voxel_m;
    const float cosine = dot(direction, normal);
    const float skipped = min(kLiftVox / cosine, kMostSkippedVox);
    const float lift = max(kLiftVox - skipped * cosine, 0.0);
    const vec3 start = point_m * per_m + lift * normal;
    const float to_lamp = (distance_m - min(kTrialLampM, 0.3 * distance_m)) * per_m;
    const float reach = min(to_lamp, to_ball_end(start, direction, params.ball_m));
    return march(start, direction, skipped, reach, cosine, lift, kInsideVox).open;
}

void main() {
    const uint item = gl_GlobalInvocationID.x, trial = gl_WorkGroupID.y;
    const LightSample lit = samples[item];
    grid = params.grid;
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
