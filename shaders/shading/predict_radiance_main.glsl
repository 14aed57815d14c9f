// Body of the shaders that predict what a camera sees: the diffuse albedo between the records around each surface point
// (paper, Section 3.7), the material of its segment, and the radiance under all lights (Eq. 6). The includer declares
// the view's grid of blocks and the packed records and how to load them:
//   CELL(i)      uint, the block id in a cell of the view grid
//   ENTRY(i)     uint, an entry of the table of records by voxel of each block
//   PACKED(i)    uvec4, a packed record
#include "lib/brdf/ward.glsl"
#include "lib/camera/camera.glsl"
#include "lib/camera/view_grid.glsl"
#include "lib/lighting/lamp_emission.glsl"
#include "lib/math/mean.glsl"
#include "lib/math/pi.glsl"
#include "lib/records/blend_records.glsl"
#include "lib/records/gathered_light.glsl"
#include "shared/shading/predict_radiance.h"
#include "shared/shading/reflect_surroundings.h"

layout(local_size_x = kPredictGroupX, local_size_y = kPredictGroupY) in;
layout(binding = 0, rgba32f) uniform readonly image2D position_m;
layout(binding = 1, rgba16f) uniform readonly image2D normal;
layout(std140, binding = 2) uniform View { ViewParams view; };
layout(std140, binding = 3) uniform Lights {
    LightHeader header;
    PointLight lights[kMaxPointLights];
};
layout(std430, binding = 7) readonly buffer Records { VoxelRecord records[]; };
layout(std430, binding = 8) readonly buffer Visibility { uvec2 visibility[]; };
layout(std430, binding = 9) readonly buffer Materials { SegmentMaterial materials[]; };
layout(binding = 10, rgba16f) uniform writeonly image2D kd;        // a = 1 where known
layout(binding = 11, r32ui) uniform writeonly uimage2D label;      // 0: none
layout(binding = 12, rgba16f) uniform writeonly image2D ks_alpha;  // rgb, Ward roughness
layout(std430, binding = 14) readonly buffer Segments { SegmentAlbedo segments[]; };
layout(binding = 13, rgba16f) uniform writeonly image2D rgb;  // linear pixel value; a = 1 where kd is known
layout(binding = 15, rgba16f) uniform writeonly image2D
    light;  // irradiance / pi; a: the part that shadows leave, kNotMarched where it is not known
layout(std430, binding = 16) readonly buffer Status { RecordStatus status[]; };
layout(std430, binding = 17) readonly buffer Gathered { RecordSurroundings gathered[]; };
layout(binding = 18, rgba16f) uniform writeonly image2D picture_kd;              // what light multiplies in rgb
layout(std430, binding = 19) writeonly buffer Glossy { GlossyPixel glossy[]; };  // where gloss is apart
layout(push_constant) uniform Push { PredictRadianceParams params; };

layout(constant_id = 0) const uint kMostLights = kMaxPointLights;  // the buffer has no more

layout(constant_id = 1) const uint kGathers = 0u;  // 1: records know what arrives from all around

// 1: kd is the one that rgb is made with, without regard to the albedo of the surface around records
layout(constant_id = 2) const uint kOfPicture = 0u;

// 1: what gloss mirrors of the light from all around is not in rgb, and added later
layout(constant_id = 3) const uint kGlossApart = 0u;

// 1: records were observed under other lights
layout(constant_id = 4) const uint kOtherLight = 0u;

// How far around a point a record fills in, voxels. Under lights that frames showed, what no record knows is the fused
// colour (restore_detail.comp); under others there is none.
const int kFillVox = kOtherLight != 0u ? 5 : 1, kFillEdge = 2 * kFillVox + 2;

const float kLeastAlpha = 0.01;
const float kMetalKd = 0.03, kDiffuseKd = 0.12;
const float kKnownWeight = 0.1;  // of a channel, from which on the records' own kd is shown

// Copies from the uniform buffer, whose loads software devices do not hoist out of loops.
ivec3 grid_low;
uvec3 grid_size;

uint find_record(uint cell, uint voxel) {
    const uint block = CELL(cell == kOutsideGrid ? 0u : cell);
    if (cell == kOutsideGrid || block == kNoBlock) return kNoRecord;
    return ENTRY(block << 3u * params.edge_shift | voxel);
}

uint near_record[8];    // the records around the point
float share_of[8];      // their parts of what reaches the point of the lights; 0: not known
uvec2 visible_from[8];  // a bit per light

// The trilinear mean over the eight records around the point, without those that are unknown or of another surface.
Reflectance interpolate(SurfacePoint point) {
    const ivec3 low = ivec3(floor(point.at_vox));
    const vec3 t = point.at_vox - vec3(low);
    RecordSums sums = no_records();
    // What addresses of the corners have in common is computed once per axis.
    const uvec3 mask = uvec3((1u << params.edge_shift) - 1u);
    const uvec3 strides = uvec3(1u, grid_size.x, grid_size.x * grid_size.y);
    const uvec3 shifts = uvec3(0u, params.edge_shift, 2u * params.edge_shift);
    const uvec3 low_block = uvec3((low >> int(params.edge_shift)) - grid_low);
    const uvec3 high_block = uvec3((low + 1 >> int(params.edge_shift)) - grid_low);
    const bvec3 low_inside = lessThan(low_block, grid_size), high_inside = lessThan(high_block, grid_size);
    const uvec3 low_cell = low_block * strides, high_cell = high_block * strides;
    const uvec3 low_voxel = (uvec3(low) & mask) << shifts, high_voxel = (uvec3(low + 1) & mask) << shifts;
    [[unroll]] for (int i = 0; i < 8; ++i) {
        const ivec3 corner = ivec3(i & 1, i >> 1 & 1, i >> 2);
        const bvec3 high = notEqual(corner, ivec3(0));
        const uvec3 cell = mix(low_cell, high_cell, high);
        const uvec3 voxel = mix(low_voxel, high_voxel, high);
        const bool inside = all(mix(low_inside, high_inside, high));
        const uint record = find_record(inside ? cell.x + cell.y + cell.z : kOutsideGrid, voxel.x | voxel.y | voxel.z);
        const bool have = record != kNoRecord;
        const uvec4 content = PACKED(have ? record : 0u);
        const vec3 share = mix(1.0 - t, t, vec3(corner));
        const uint alike = kOfPicture != 0u ? 0u : gathered[have ? record : 0u].around;
        const float weight =
            add_record(sums, point, record, content, alike, t - vec3(corner), share.x * share.y * share.z);
        near_record[i] = have ? record : 0u;
        share_of[i] = packed_marched(content) ? weight : 0.0;
        visible_from[i] = uvec2(content.w, 0u);
    }
    return mean_of(sums);
}

// Where none of the eight is known: what the nearest known record around has; one of the same surface if there is any.
// Rims, which no frame saw but grazing, have normals too far off to tell.
Reflectance fill(SurfacePoint point, Reflectance found) {
    const ivec3 low = ivec3(floor(point.at_vox)) - kFillVox;
    NearestRecords nearest = nearest_after(found);
    for (int row = 0; row < kFillEdge * kFillEdge; ++row) {
        [[unroll]] for (int x = 0; x < kFillEdge; ++x) {
            const ivec3 voxel = low + ivec3(x, row % kFillEdge, row / kFillEdge);
            const uint cell = view_grid_cell(grid_low, grid_size, voxel >> int(params.edge_shift));
            const uint record = find_record(cell, voxel_number(voxel, params.edge_shift));
            const uvec4 content = PACKED(record == kNoRecord ? 0u : record);
            look_at_record(nearest, point, record, content, point.at_vox - vec3(voxel));
        }
    }
    const uvec4 content = PACKED(nearest.known == kNoRecord ? 0u : nearest.known);
    float marched = 0.0;
    [[unroll]] for (int i = 0; i < 8; ++i) marched += share_of[i];
    if (packed_marched(content) && nearest.known != kNoRecord && marched == 0.0) {
        near_record[0] = nearest.known;
        share_of[0] = 1.0;
        visible_from[0] = uvec2(content.w, 0u);
    }
    return filled(found, nearest, content);
}

// Makes the shares sum to 1. Where no light was marched yet, every light reaches the point; false.
bool normalise_shares() {
    float all = 0.0;
    [[unroll]] for (int i = 0; i < 8; ++i) all += share_of[i];
    const float scale = all > 0.0 ? 1.0 / all : 0.0;
    [[unroll]] for (int i = 0; i < 8; ++i) share_of[i] *= scale;
    share_of[0] = all > 0.0 ? share_of[0] : 1.0;
    visible_from[0] = all > 0.0 ? visible_from[0] : uvec2(0xffffffffu);
    return all > 0.0 || params.shadows == 0u;
}

// The share of the surface around the point that a light reaches.
float share_lit(uint light) {
    float lit = 0.0;
    [[unroll]] for (int i = 0; i < 8; ++i) {
        const uint bits = light < kLightsOfOneWord ? visible_from[i].x : visible_from[i].y;
        lit += (bits >> (light & 31u) & 1u) != 0u ? share_of[i] : 0.0;
    }
    return params.shadows == 0u ? 1.0 : lit;
}

void load_further_visibility() {
    [[unroll]] for (int i = 0; i < 8; ++i) visible_from[i].y = visibility[near_record[i]].y;
}

// What arrives from all around beside the lamps: irradiance over pi. Shares sum to 1.
vec3 indirect_light(bool marched) {
    if (kGathers == 0u || !marched) return header.ambient.rgb;
    vec3 sum = vec3(0.0);
    [[unroll]] for (int i = 0; i < 8; ++i) {
        const uvec2 incident = status[near_record[i]].incident;
        sum += share_of[i] > 0.0 ? share_of[i] * gathered_irradiance(unpack_gathered(incident), header.ambient.rgb)
                                 : vec3(0.0);
    }
    return sum;
}

// What arrives of the lamps' light, and what of it the surface sends to the viewer, while it is summed up.
struct LampLight {
    vec3 received;  // irradiance
    vec3 glossy;    // radiance where ks is 1
    float arriving, all;
};

void add_lamp(inout LampLight sums, uint i, bool counts, SurfacePoint point, vec3 point_m, float alpha) {
    const vec3 offset = lights[i].position_m.xyz - point_m;
    const float inverse2 = 1.0 / max(dot(offset, offset), 1e-20);
    const vec3 to_light = offset * sqrt(inverse2);
    const float facing = counts ? max(dot(point.normal, to_light), 0.0) * inverse2 : 0.0;
    const vec3 unshadowed = intensity_from(lights[i], to_light) * facing;
    const float lit = share_lit(i);
    const vec3 received = lit * unshadowed;
    sums.received += received;
    sums.glossy += received * ward_lobe(alpha, point.normal, to_light, point.to_viewer);
    const float strength = unshadowed.r + unshadowed.g + unshadowed.b;
    sums.arriving += lit * strength;
    sums.all += strength;
}

struct Shade {
    vec3 rgb;       // radiance towards the viewer
    vec3 light;     // of it what kd multiplies: irradiance / pi
    float arrives;  // the part of the lamps' unshadowed light that arrives
};

Shade shade(SurfacePoint point, vec3 point_m, vec3 kd, vec4 gloss, vec3 indirect) {
    LampLight sums = LampLight(vec3(0.0), vec3(0.0), 0.0, 0.0);
    const float alpha = max(gloss.w, kLeastAlpha);
    // Below the viewer's horizon an interpolated normal shows nothing of the lamps.
    const uint count = dot(point.normal, point.to_viewer) > 0.0 ? header.count : 0u;
    if (kMostLights <= kFewLights) {
        [[unroll]] for (uint i = 0u; i < kFewLights; ++i) add_lamp(sums, i, i < count, point, point_m, alpha);
    } else {
        for (uint i = 0u; i < count; ++i) add_lamp(sums, i, true, point, point_m, alpha);
    }
    const vec3 light = indirect + sums.received * (1.0 / kPi);
    const vec3 reflected = kGathers != 0u && kGlossApart == 0u ? gloss.rgb * indirect : vec3(0.0);
    return Shade(kd * light + gloss.rgb * sums.glossy + reflected, light,
                 sums.all > 0.0 ? sums.arriving / sums.all : 0.0);
}

// Under the light that records gathered its errors cancel out against those of their own kd. So pictures are made from
// that, where it is known at all, though the segment tells more of the albedo.
vec3 shaded_kd(Reflectance own, Reflectance with_segment) {
    if (kGathers == 0u || kOtherLight != 0u || !own.known) return with_segment.kd;
    return mix(with_segment.kd, own.kd, clamp(own.weights / kKnownWeight, 0.0, 1.0));
}

// A metal or a mirror has no diffuse part. What has one is something else in the same segment, such as a frame.
float metal_share(Reflectance own, float mirror) {
    const vec3 known_kd = own.known ? own.kd * clamp(own.weights / kKnownWeight, 0.0, 1.0) : vec3(0.0);
    return 1.0 - mirror * smoothstep(kMetalKd, kDiffuseKd, mean_of(known_kd));
}

uvec2 pack_halves(vec4 values) { return uvec2(packHalf2x16(values.rg), packHalf2x16(values.ba)); }

void main() {
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(position_m)))) return;
    grid_low = view.grid_low.xyz;
    grid_size = view.grid_size.xyz;
    const vec4 hit = imageLoad(position_m, pixel);
    vec4 known_kd = vec4(0.0), shaded_with = vec4(0.0), gloss = vec4(0.0), shaded = vec4(0.0), received = vec4(0.0);
    uint segment = 0u;
    GlossyPixel apart = GlossyPixel(uvec2(0u), uvec2(0u));
    if (hit.w > 0.0) {
        const SurfacePoint point = SurfacePoint(hit.xyz / params.voxel_m - 0.5, imageLoad(normal, pixel).xyz,
                                                normalize(camera_center_m(view.camera) - hit.xyz));
        Reflectance found = interpolate(point);
        if (!found.known) found = fill(point, found);
        segment = found.labelled == kNoRecord ? 0u : record_label(records[found.labelled]);
        const bool has_entry = segment != 0u && segment < params.materials;
        const SegmentMaterial material = materials[has_entry ? segment : 0u];
        gloss = has_entry ? material.ks_alpha : vec4(0.0);
        if (has_entry) gloss.rgb *= metal_share(found, material.mirror);
        // What is a guess was not taken from kd either.
        const vec4 shown_gloss = vec4(gloss.rgb * (1.0 - material.unobserved), gloss.w);
        const Reflectance own = found;
        found = with_segment(found, has_entry ? segment_kd(segments[segment]) : vec4(0.0), point.to_viewer);
        if (kMostLights > kLightsOfOneWord) load_further_visibility();
        const bool marched = normalise_shares();
        const vec3 facing = normalize(point.normal != vec3(0.0) ? point.normal : found.normal);
        const vec3 of_picture = shaded_kd(own, found);
        shaded_with = found.known ? vec4(of_picture, 1.0) : vec4(0.0);
        const vec3 indirect = indirect_light(marched);
        const Shade seen =
            shade(SurfacePoint(point.at_vox, facing, point.to_viewer), hit.xyz, of_picture, shown_gloss, indirect);
        apart = GlossyPixel(pack_halves(shown_gloss), pack_halves(vec4(indirect, 0.0)));
        known_kd = kOfPicture != 0u ? shaded_with : found.known ? vec4(found.kd, 1.0) : vec4(0.0);
        shaded = found.known ? vec4(seen.rgb, 1.0) : vec4(0.0);
        received = vec4(seen.light, marched ? seen.arrives : kNotMarched);
    }
    imageStore(kd, pixel, known_kd);
    imageStore(picture_kd, pixel, shaded_with);
    imageStore(label, pixel, uvec4(segment));
    imageStore(ks_alpha, pixel, gloss);
    imageStore(rgb, pixel, shaded);
    imageStore(light, pixel, received);
    if (kGlossApart != 0u) glossy[pixel.y * imageSize(position_m).x + pixel.x] = apart;
}
