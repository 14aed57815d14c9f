// Body of the shaders that gather the light which reaches a record from what is around it. The includer declares the
// map's table, distances and colours and how to load them, as lib/lighting/incident_light.glsl says.
#include "lib/math/hemisphere.glsl"
#include "lib/math/pi.glsl"
#include "lib/math/random.glsl"
#include "lib/records/gathered_light.glsl"
#include "lib/records/record_hash.glsl"
#include "lib/records/reflectance.glsl"
#include "shared/lighting/lights.h"
#include "shared/reflectance/far_field.h"
#include "shared/reflectance/surroundings.h"

const uint kLanes = 4u;  // of a record, each of which marches every kLanes-th of its rays

layout(local_size_x = kLanes * kRecordGroup) in;
layout(constant_id = 1) const uint kRays = 8u;     // of a record in one update
layout(constant_id = 2) const uint kForgets = 0u;  // 1: what was gathered before counts no longer
layout(std140, binding = 0) uniform Lights {
    LightHeader header;
    PointLight lights[kMaxPointLights];
};
layout(std430, binding = 1) readonly buffer Records { VoxelRecord records[]; };
layout(std430, binding = 2) readonly buffer March { uint listed[]; };
layout(std430, binding = 3) buffer Gathered { RecordSurroundings gathered[]; };
layout(std430, binding = 16) readonly buffer Surroundings{SURROUNDINGS_MEMBERS};
layout(push_constant) uniform Push { ReflectanceParams params; };
#include "lib/lighting/incident_light.glsl"

// Cosine-weighted.
vec3 ray_direction(uvec2 stream, uint index, mat3 frame) {
    const vec2 u = unit_interval(stratified_words(stream, index, 0u)).xy;
    const float radius = sqrt(u.x), angle = 2.0 * kPi * u.y;
    return frame * vec3(radius * cos(angle), radius * sin(angle), sqrt(1.0 - u.x));
}

shared vec3 sums[kRecordGroup][kLanes];
shared float mets[kRecordGroup][kLanes];

// Sums a lane's rays.
void gather(VoxelRecord known, uint lane, out vec3 sum, out float met) {
    grid = params.voxels;
    const vec3 normal = surface_normal(known);
    const vec3 point_vox = surface_point_m(known, params.records, params.edge_shift) / grid.voxel_m;
    const mat3 frame = tangent_frame(normal);
    const uvec2 stream = uvec2(hash_of_voxel(known.block_key, voxel_in_block(known)), 0u);
    sum = vec3(0.0);
    met = 0.0;
    for (uint i = lane; i < kRays; i += kLanes) {
        const vec3 direction = ray_direction(stream, params.stamp * kRays + i, frame);
        const Incident light = incident_light(point_vox, normal, direction, params.ball_m);
        sum += light.radiance;
        met += light.known ? 1.0 : 0.0;
    }
}

void main() {
    // Rays of one record lie side by side, so that a record takes as long as its longest ray, not as their sum.
    const uint place = gl_LocalInvocationID.x / kLanes, lane = gl_LocalInvocationID.x % kLanes;
    const uint item = gl_WorkGroupID.x * kRecordGroup + place;
    const bool has_record = item < listed[0];
    const uint record = has_record ? listed[1u + item] : kNoRecord;
    if (has_record) gather(records[record], lane, sums[place][lane], mets[place][lane]);
    barrier();
    if (!has_record || lane != 0u) return;
    vec3 sum = vec3(0.0);
    float met = 0.0;
    for (uint i = 0u; i < kLanes; ++i) {
        sum += sums[place][i];
        met += mets[place][i];
    }
    const GatheredLight light = unpack_gathered(kForgets != 0u ? uvec2(0u) : gathered[record].rays);
    gathered[record].rays = pack_gathered(with_rays(light, sum, met, float(kRays) - met));
}
