#version 460
#extension GL_GOOGLE_include_directive : require
// The albedo of the surface around each record: what the cells around it reflect over what they receive, interpolated.
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
layout(std430, binding = 6) readonly buffer Surfaces {
    uint used;
    uint pad[3];
    SurfaceCell cells[];
};
layout(std430, binding = 7) buffer Gathered { RecordSurroundings gathered[]; };
layout(push_constant) uniform Push { SurfaceAlbedoParams params; };
#include "lib/records/reflected_light.glsl"

const float kLightError = 0.3;     // of the light that is gathered, relative
const float kMissingError = 0.3;   // and where some is missing, as a part of that
const float kLeastMissing = 0.05;  // of the records around, from which on they show that light is missing
const float kBrightAlbedo = 0.8;
const float kLeastAlike = 3.0;  // records that a segment's tint takes

uint find_cell(uint key) {
    for (uint probe = 0u; probe < kSurfaceProbes; ++probe) {
        const uint at = surface_cell_place(key, probe);
        if (cells[at].key == key) return at;
        if (cells[at].key == 0u) break;
    }
    return kNoRecord;
}

struct Sums {
    vec3 reflected, light;
    float records;
};

void add_cell(inout Sums sums, uint key, float share) {
    const uint cell = find_cell(key);
    if (cell == kNoRecord) return;
    sums.reflected += share * vec3(cells[cell].reflected_r, cells[cell].reflected_g, cells[cell].reflected_b);
    sums.light += share * vec3(cells[cell].light_r, cells[cell].light_g, cells[cell].light_b);
    sums.records += share * float(cells[cell].records);
}

vec3 albedo_of(Sums sums) { return clamp(sums.reflected / max(sums.light, 1e-6), 0.0, 1.0); }

// Of the cells around.
Sums near_surface(SurfacePlace place) {
    const ivec4 low = ivec4(floor(place.at));
    const vec4 t = place.at - vec4(low);
    Sums sums = Sums(vec3(0.0), vec3(0.0), 0.0);
    for (int i = 0; i < 16; ++i) {
        const ivec4 corner = ivec4(i & 1, i >> 1 & 1, i >> 2 & 1, i >> 3);
        const vec4 shares = mix(1.0 - t, t, vec4(corner));
        const uint key = surface_key(low + corner, ivec2(round(place.tint)), place.side);
        add_cell(sums, key, shares.x * shares.y * shares.z * shares.w);
    }
    return sums;
}

// Of what has about the same tint in the segment.
Sums same_tint(SurfacePlace place, uint label) {
    const ivec2 low = ivec2(floor(place.tint));
    const vec2 t = place.tint - vec2(low);
    Sums sums = Sums(vec3(0.0), vec3(0.0), 0.0);
    for (int i = 0; i < 4; ++i) {
        const ivec2 corner = ivec2(i & 1, i >> 1);
        const vec2 shares = mix(1.0 - t, t, vec2(corner));
        add_cell(sums, segment_tint_key(label, low + corner), shares.x * shares.y);
    }
    return sums;
}

// How many times more light arrives around than is known, where some of the surface there reflects more than that: in a
// patch of sun, say. Its brightest parts are taken to have a usual bright albedo.
float missing_light(SurfacePlace place) {
    const ivec3 low = ivec3(floor(place.at.xyz));
    const vec3 t = place.at.xyz - vec3(low);
    Sums sums = Sums(vec3(0.0), vec3(0.0), 0.0);
    for (int i = 0; i < 8; ++i) {
        const ivec3 corner = ivec3(i & 1, i >> 1 & 1, i >> 2);
        const vec3 shares = mix(1.0 - t, t, vec3(corner));
        add_cell(sums, light_key(low + corner, place.side), shares.x * shares.y * shares.z);
    }
    const float impossible = sums.reflected.r / kSurfaceSteps;
    if (impossible < kLeastMissing * sums.records || impossible < 1.0) return 1.0;
    return max(sums.reflected.g / sums.reflected.r / kBrightAlbedo, 1.0);
}

uint albedo_around(uint record) {
    const Reflected told = reflected_by(record);
    const bool impossible = told.impossible > 0.0;
    if (!(told.known || impossible) || used > kMostSurfaceCells) return 0u;
    const float more = missing_light(told.place);
    const vec3 near = (impossible ? told.reflected / told.light : albedo_of(near_surface(told.place))) / more;
    const Sums alike = same_tint(told.place, record_label(records[record]));
    // By inverse variances. What light is off by is much the same all around.
    const vec3 deviation = (kLightError + kMissingError * (more - 1.0)) * near + kSurfaceDeviation;
    const float weight = record_label(records[record]) != 0u && alike.records >= kLeastAlike
                             ? 1.0 / (kTextureDeviation * kTextureDeviation)
                             : 0.0;
    const vec3 own = 1.0 / (deviation * deviation);
    const vec3 kd = (own * near + weight * albedo_of(alike)) / (own + weight);
    return max(pack_shared_exponent(clamp(kd, 0.0, 1.0)), 1u);
}

void main() {
    const uint end = counters.high_water;
    uint record = gl_WorkGroupID.x * kRecordsPerItem * kRecordGroup + gl_LocalInvocationID.x;
    for (uint i = 0u; i < kRecordsPerItem && record < end; ++i, record += kRecordGroup)
        if (is_in_cube(record)) gathered[record].around = albedo_around(record);
}
