#version 460
#extension GL_GOOGLE_include_directive : require
// Adds up what records reflect and receive, by cells of surface that looks alike.
#include "lib/records/surface_cells.glsl"

layout(local_size_x = kRecordGroup) in;
layout(constant_id = 0) const uint kRecordsPerItem = 1u;  // a group of the dispatch has as many groups of records
layout(std140, binding = 0) uniform Lights {
    LightHeader header;
    PointLight lights[kMaxPointLights];
};
layout(std430, binding = 1) readonly buffer RecordCounters { MapCounters counters; };
layout(std430, binding = 2) readonly buffer Records { VoxelRecord records[]; };
layout(std430, binding = 3) readonly buffer Albedo { uvec2 albedo[]; };
layout(std430, binding = 4) readonly buffer Visibility { uvec2 visibility[]; };
layout(std430, binding = 5) readonly buffer Status { RecordStatus status[]; };
layout(std430, binding = 6) buffer Surfaces {
    uint used;
    uint pad[3];
    SurfaceCell cells[];
};
layout(push_constant) uniform Push { SurfaceAlbedoParams params; };

#include "lib/records/reflected_light.glsl"

void add_to(uint key, vec3 reflected, vec3 light) {
    const uvec3 r = uvec3(clamp(reflected, 0.0, kSurfaceRange) * kSurfaceSteps + 0.5);
    const uvec3 l = uvec3(clamp(light, 0.0, kSurfaceRange) * kSurfaceSteps + 0.5);
    for (uint probe = 0u; probe < kSurfaceProbes; ++probe) {
        const uint place = surface_cell_place(key, probe);
        const uint found = atomicCompSwap(cells[place].key, 0u, key);
        if (found == 0u) atomicAdd(used, 1u);
        if (found != 0u && found != key) continue;
        atomicAdd(cells[place].records, 1u);
        atomicAdd(cells[place].reflected_r, r.r);
        atomicAdd(cells[place].reflected_g, r.g);
        atomicAdd(cells[place].reflected_b, r.b);
        atomicAdd(cells[place].light_r, l.r);
        atomicAdd(cells[place].light_g, l.g);
        atomicAdd(cells[place].light_b, l.b);
        return;
    }
}

void add_record(uint record) {
    const Reflected told = reflected_by(record);
    const bool impossible = told.impossible > 0.0;
    if (told.known || impossible) {
        const vec3 counts = impossible ? vec3(1.0, told.impossible, 0.0) : vec3(0.0);
        add_to(light_key(ivec3(round(told.place.at.xyz)), told.place.side), counts, vec3(0.0));
    }
    if (!told.known || impossible) return;
    const ivec2 tint = ivec2(round(told.place.tint));
    add_to(surface_key(ivec4(round(told.place.at)), tint, told.place.side), told.reflected, told.light);
    // A segment's records count alike, however much light they receive.
    const vec3 kd = albedo_kd(albedo[record]);
    add_to(segment_tint_key(record_label(records[record]), tint), kd, vec3(1.0));
}

void main() {
    const uint end = counters.high_water;
    uint record = gl_WorkGroupID.x * kRecordsPerItem * kRecordGroup + gl_LocalInvocationID.x;
    for (uint i = 0u; i < kRecordsPerItem && record < end; ++i, record += kRecordGroup) add_record(record);
}
