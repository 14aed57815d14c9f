// What a record reflects diffusely and what it receives, where that tells of its albedo. The includer declares
//   layout(std140, binding = n) uniform Lights { LightHeader header; PointLight lights[kMaxPointLights]; };
//   layout(std430, binding = n) readonly buffer Records { VoxelRecord records[]; };
//   layout(std430, binding = n) readonly buffer Albedo { uvec2 albedo[]; };
//   layout(std430, binding = n) readonly buffer Visibility { uvec2 visibility[]; };
//   layout(std430, binding = n) readonly buffer Status { RecordStatus status[]; };
//   layout(push_constant) uniform Push { SurfaceAlbedoParams params; };
#ifndef PATINA_LIB_REFLECTED_LIGHT_GLSL
#define PATINA_LIB_REFLECTED_LIGHT_GLSL
#include "lib/records/gathered_light.glsl"
#include "lib/records/lamp_light.glsl"
#include "lib/records/surface_cells.glsl"

const float kMostReflected = 0.95;    // of a pixel value: what is above may be clipped
const float kMostDoubtedShare = 0.3;  // of the light: more may be a shadow's border
const float kLeastImpossible = 2.0;   // an albedo: errors of the light alone do not ask for more
const float kLeastReceived = 0.004;   // over pi, as refinement has it

struct Reflected {
    vec3 reflected;  // pixel values
    vec3 light;      // irradiance over pi
    SurfacePlace place;
    bool known;
    float impossible;  // the albedo that the light would ask for, where that is too large to be one; else 0
};

bool is_in_cube(uint record) {
    const ivec3 block = block_of_key(params.grid, records[record].block_key);
    const ivec3 voxel = voxel_of_record(block, voxel_in_block(records[record]), params.edge_shift);
    const vec3 off_m = (vec3(voxel) + 0.5) * params.grid.voxel_m - params.cube_m.xyz;
    return max(max(abs(off_m.x), abs(off_m.y)), abs(off_m.z)) <= params.cube_m.w;
}

Reflected reflected_by(uint record) {
    const VoxelRecord known = records[record];
    const vec3 normal = surface_normal(known);
    const vec3 point_m = surface_point_m(known, params.grid, params.edge_shift);
    const GatheredLight gathered = unpack_gathered(status[record].incident);
    vec3 light = gathered_irradiance(gathered, header.ambient.rgb), doubted = vec3(0.0);
    for (uint i = 0u; i < header.count; ++i) {
        const vec3 sent = lamp_light(i, point_m, normal);
        light += bit_is_set(visibility[record], i) ? sent : vec3(0.0);
        doubted += bit_is_set(status[record].uncertain, i) ? sent : vec3(0.0);
    }
    const vec3 reflected = albedo_raw_kd(albedo[record]) * light;
    const float brightest = max(max(reflected.r, reflected.g), reflected.b);
    const bool received = observation_count(known) > 0u && status[record].refined != 0u && gathered.met > 0.0 &&
                          all(greaterThan(light, vec3(kLeastReceived))) &&
                          mean_of(doubted) < kMostDoubtedShare * mean_of(light) && is_in_cube(record);
    const bool tells = received && brightest < kMostReflected;
    const float asked = received ? mean_of(reflected) / mean_of(light) : 0.0;
    const float impossible = asked > kLeastImpossible ? asked : 0.0;
    return Reflected(reflected, light, surface_place(point_m, normal, reflected), tells, impossible);
}

#endif
