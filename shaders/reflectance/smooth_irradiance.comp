#version 460
#extension GL_GOOGLE_include_directive : require
// Takes the rays of a record together with those of the records beside it on the same surface, where much the same
// light arrives: a ninth of the noise's square. What records gathered stays as it is, so that their order does not
// matter.
#include "shared/reflectance/reflectance.h"

layout(local_size_x = kRecordGroup) in;
layout(std430, binding = 0) readonly buffer Keys { uvec4 keys[]; };
layout(std430, binding = 1) readonly buffer Blocks { uint blocks[]; };
layout(std430, binding = 2) readonly buffer RecordTable { uint record_table[]; };
layout(std430, binding = 3) readonly buffer Records { VoxelRecord records[]; };
layout(std430, binding = 4) readonly buffer March { uint listed[]; };
layout(std430, binding = 6) readonly buffer Gathered { RecordSurroundings gathered[]; };
layout(std430, binding = 5) writeonly buffer Status { RecordStatus status[]; };
layout(push_constant) uniform Push { ReflectanceParams params; };
#define KEYS(bucket) keys[bucket]
#define BLOCK(slot) blocks[slot]
#define RECORD(entry) record_table[entry]
#include "lib/math/mean.glsl"
#include "lib/records/find_record.glsl"
#include "lib/records/gathered_light.glsl"
#include "lib/records/reflectance.glsl"

const float kSameCosine = 0.9;  // between the normals of one surface
const float kOffPlaneVox = 1.0;
const float kLeastWorth = 8.0;  // usual rays
const uint kNeighbours = 27u;   // with the record itself

vec3 surface_at_vox(VoxelRecord record, ivec3 voxel) {
    return vec3(voxel) + surface_normal(record) * surface_offset_vox(record);
}

void main() {
    const uint item = gl_GlobalInvocationID.x;
    if (item >= listed[0]) return;
    const uint record = listed[1u + item];
    const VoxelRecord own = records[record];
    const ivec3 center =
        voxel_of_record(block_of_key(params.records, own.block_key), voxel_in_block(own), params.edge_shift);
    const vec3 normal = surface_normal(own), point_vox = surface_at_vox(own, center);
    GatheredLight sum = GatheredLight(vec3(0.0), 0.0, 0.0);
    float squares = 0.0, bright = 0.0, bright2 = 0.0;  // of the records' rays, and with these of their mean brightness
    for (uint i = 0u; i < kNeighbours; ++i) {
        const ivec3 voxel = center + ivec3(i % 3u, i / 3u % 3u, i / 9u) - 1;
        const uint other = voxel == center ? record : find_record(params.records, params.edge_shift, voxel);
        if (other == kNoRecord) continue;
        const VoxelRecord beside = records[other];
        const float off_vox = abs(dot(normal, surface_at_vox(beside, voxel) - point_vox));
        if (dot(normal, surface_normal(beside)) < kSameCosine || off_vox > kOffPlaneVox) continue;
        const GatheredLight light = unpack_gathered(gathered[other].rays);
        sum.mean += light.met * light.mean;
        sum.met += light.met;
        sum.missed += light.missed;
        const float brightness = mean_of(light.mean), rays2 = light.met * light.met;
        squares += rays2;
        bright += rays2 * brightness;
        bright2 += rays2 * brightness * brightness;
    }
    sum.mean /= max(sum.met, 1.0);
    // How far the records differ tells what the mean is worth: so many usual rays.
    const float mean = mean_of(sum.mean), error2 = bright2 - 2.0 * mean * bright + mean * mean * squares;
    const float worth = kRayError * kRayError * mean * mean * sum.met * sum.met / max(error2, 1e-12);
    const float rays = clamp(worth, kLeastWorth, kMostGatheredRays);
    const float kept = min(rays / max(sum.met + sum.missed, 1.0), 1.0);
    status[record].incident = pack_gathered(GatheredLight(sum.mean, kept * sum.met, kept * sum.missed));
}
