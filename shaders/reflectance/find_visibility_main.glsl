// Body of the shaders that find which lights reach a voxel. The includer declares the map's table and distances and how
// to load them, as lib/map/march_map.glsl says.
#include "lib/records/record_list.glsl"
#include "lib/records/reflectance.glsl"
#include "shared/reflectance/far_field.h"
#include "shared/reflectance/surroundings.h"

layout(local_size_x = kRecordGroup) in;
layout(std140, binding = 0) uniform Lights {
    LightHeader header;
    PointLight lights[kMaxPointLights];
};
layout(std430, binding = 1) readonly buffer Records { VoxelRecord records[]; };
layout(std430, binding = 2) readonly buffer March { uint listed[]; };
layout(std430, binding = 3) buffer Status { RecordStatus status[]; };
layout(std430, binding = 4) buffer Visibility { uvec2 visibility[]; };
layout(std430, binding = 5) buffer Refine { uint refine[]; };
layout(std430, binding = 6) buffer RefineArguments { uint refine_arguments[]; };
layout(std430, binding = 14) readonly buffer Surroundings{SURROUNDINGS_MEMBERS};
layout(push_constant) uniform Push { ReflectanceParams params; };
#define BLOCKS_IN_USE blocks_in_use
#include "lib/lighting/march_surroundings.glsl"
#include "lib/map/march_map.glsl"

layout(constant_id = 1) const uint kGathers = 0u;  // 1: light is gathered for the same records, which changes albedos

const float kLiftVox = 2.5;         // from where the march starts, above the surface
const float kMostSkippedVox = 7.5;  // of the way, to get there
const float kGrazeShare = 0.5;      // of a record's voxel
const float kLampMarginVox = 3.0;   // kept from a lamp, whose own surface is in the map
const float kUnknownLampM = 0.15;   // the radius assumed of a lamp whose radius is not known
const float kMostLampShare = 0.3;   // of the way to it
const float kGrazingCosine = 0.12;  // 7 degrees above the surface, about what its normal may be off
const float kBackCosine = -0.2;     // lights behind the surface by more do not reach it

Passage light_passage(vec3 point_m, vec3 normal, PointLight light) {
    const float inverse_voxel = 1.0 / grid.voxel_m;
    const vec3 offset_vox = (light.position_m.xyz - point_m) * inverse_voxel;
    const float distance_vox = max(length(offset_vox), 1e-6);
    const vec3 direction = offset_vox / distance_vox;
    const float cosine = dot(direction, normal);
    if (cosine < kBackCosine) return Passage(false, false);
    if (light.intensity.w > 0.0 && !passes_sky(point_m, normal, direction)) return Passage(false, false);
    // Above the surface, if possible on the way itself, as a lifted way would move the shadow.
    const float skipped = min(kLiftVox / max(cosine, 1e-6), kMostSkippedVox);
    const float lift = max(kLiftVox - skipped * cosine, 0.0);
    const float lamp_m = light.position_m.w > 0.0 ? light.position_m.w : kUnknownLampM;
    const float lamp_vox = min(lamp_m * inverse_voxel + kLampMarginVox, kMostLampShare * distance_vox);
    const float graze_vox = kGrazeShare * params.records.voxel_m * inverse_voxel;
    const vec3 start = point_m * inverse_voxel + lift * normal;
    const float reach = min(distance_vox - lamp_vox, to_ball_end(start, direction, params.ball_m));
    Passage passage = march(start, direction, skipped, reach, cosine, lift, graze_vox);
    passage.uncertain = passage.uncertain || cosine < kGrazingCosine;
    return passage;
}

// Bits of the lights, in two words; all, where there are no shadows.
struct Reached {
    uvec2 open;
    uvec2 uncertain;
};

Reached find_lights(vec3 point_m, vec3 normal) {
    if (params.shadows == 0u) return Reached(uvec2(0xffffffffu), uvec2(0u));
    Reached reached = Reached(uvec2(0u), uvec2(0u));
    for (uint i = 0u; i < header.count; ++i) {
        const Passage passage = light_passage(point_m, normal, lights[i]);
        const uvec2 bit = uvec2(i < 32u ? 1u << i : 0u, i < 32u ? 0u : 1u << (i - 32u));
        reached.open |= passage.open ? bit : uvec2(0u);
        reached.uncertain |= passage.uncertain ? bit : uvec2(0u);
    }
    return reached;
}

void main() {
    const uint item = gl_GlobalInvocationID.x;
    if (item >= listed[0]) return;
    const uint record = listed[1u + item];
    const VoxelRecord known = records[record];
    grid = params.voxels;
    const vec3 normal = surface_normal(known);
    const vec3 point_m = surface_point_m(known, params.records, params.edge_shift);
    const Reached reached = find_lights(point_m, normal);
    const bool same = kGathers == 0u && is_marched(status[record].marched, header.position_version) &&
                      visibility[record] == reached.open && status[record].uncertain == reached.uncertain;
    visibility[record] = reached.open;
    status[record].uncertain = reached.uncertain;
    status[record].marched = marched_word(known, header.position_version);
    if (kGathers != 0u) status[record].bright = pack_shared_exponent(low_exposure_radiance(surroundings_cell(point_m)));
    if (!same && atomicExchange(status[record].refine_stamp, params.stamp) != params.stamp) {
        APPEND_RECORD(refine, refine_arguments, record)
    }
}
