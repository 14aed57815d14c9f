// Body of the shaders that predict what a camera sees: the diffuse albedo between the records around each surface point
// (paper, Section 3.7), the material of its segment, and the radiance under all lights (Eq. 6). The includer declares
// the view's grid of blocks and the packed records and how to load them:
//   CELL(i)      uint, the block id in a cell of the view grid
//   ENTRY(i)     uint, an entry of the table of records by voxel of each block
//   PACKED(i)    uvec4, a packed record
#include "lib/camera.glsl"
#include "lib/packed_records.glsl"
#include "lib/view_grid.glsl"
#include "lib/ward.glsl"
#include "shared/predict_radiance.h"

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
layout(push_constant) uniform Push { PredictRadianceParams params; };

// A record belongs to the surface point's own surface where their normals agree and its tangent plane passes near the
// point. Between the two values the weight falls linearly.
const float kAgreeingCosine = 0.75;
const float kOtherCosine = 0.25;
const float kOnPlaneVox = 0.5;
const float kOffPlaneVox = 1.0;
const float kLeastWeight = 1e-6;     // trilinear shares below it are none
const float kOtherSurface2 = 100.0;  // added to squared distances: what is of another surface comes last
const float kLeastAlpha = 0.01;
const float kCreaseCosine = 0.7;  // between neighbouring pixels' normals; at it, neighbours do not smooth

// Copies from the uniform buffer, whose loads software devices do not hoist out of loops.
ivec3 grid_low;
uvec3 grid_size;

struct SurfacePoint {
    vec3 at_vox;  // in voxels of the observations, whose centres are at integers
    vec3 normal;  // 0 where it is not known
    vec3 to_viewer;
};

uint find_record(uint cell, uint voxel) {
    const uint block = CELL(cell == kOutsideGrid ? 0u : cell);
    if (cell == kOutsideGrid || block == kNoBlock) return kNoRecord;
    return ENTRY(block << 3u * params.edge_shift | voxel);
}

// How much the surface of a record is that of the point, 0 to 1; `surface` is packed_surface.
float same_surface(SurfacePoint point, vec3 away_vox, vec4 surface) {
    const bool known = point.normal != vec3(0.0);
    // Where the model has no normal, all that faces the viewer will do.
    const float cosine = known ? dot(point.normal, surface.xyz) : dot(point.to_viewer, surface.xyz) > 0.0 ? 1.0 : 0.0;
    const float off = abs(dot(surface.xyz, away_vox) - surface.w);
    return clamp((cosine - kOtherCosine) / (kAgreeingCosine - kOtherCosine), 0.0, 1.0) *
           clamp((kOffPlaneVox - off) / (kOffPlaneVox - kOnPlaneVox), 0.0, 1.0);
}

uint near_record[8];    // the records around the point
float share_of[8];      // their parts of what reaches the point of the lights; 0: not known
uvec2 visible_from[8];  // a bit per light

struct Reflectance {
    vec3 kd;
    vec3 weights;  // of kd's channels, 1 where all records are certain
    bool known;
    vec3 normal;    // of the records
    uint labelled;  // the nearest record with a label, or kNoRecord
};

// The trilinear mean over the eight records around the point, without those that are unknown or of another surface.
Reflectance interpolate(SurfacePoint point) {
    const ivec3 low = ivec3(floor(point.at_vox));
    const vec3 t = point.at_vox - vec3(low);
    vec3 sum = vec3(0.0), weights = vec3(0.0), normals = vec3(0.0);
    float nearest = 1e9;
    uint labelled = kNoRecord;
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
        const vec4 surface = packed_surface(content);
        const vec3 away = t - vec3(corner);
        const float same = have ? same_surface(point, away, surface) : 0.0;
        const float weight = same * max(share.x * share.y * share.z, kLeastWeight);
        const vec3 certain = weight * packed_certainty(content);
        sum += certain * packed_kd(content);
        weights += certain;
        normals += weight * surface.xyz;
        const float distance2 = same > 0.0 && packed_has_label(content) ? dot(away, away) : 1e9;
        labelled = distance2 < nearest ? record : labelled;
        nearest = min(distance2, nearest);
        near_record[i] = have ? record : 0u;
        share_of[i] = packed_marched(content) ? weight : 0.0;
        visible_from[i] = uvec2(content.w, 0u);
    }
    const bool known = max(max(weights.r, weights.g), weights.b) > 0.0;
    return Reflectance(sum / max(weights, 1e-20), weights, known, normals, labelled);
}

// Where none of the eight is known: what the nearest known record within one voxel more has; one of the same surface if
// there is any. Rims, which no frame saw but grazing, have normals too far off to tell.
Reflectance fill(SurfacePoint point, Reflectance found) {
    const ivec3 low = ivec3(floor(point.at_vox)) - 1;
    float nearest = 1e9, nearest_label = found.labelled == kNoRecord ? 1e9 : -1.0;
    uvec4 content = uvec4(0u);
    uint chosen = kNoRecord;
    for (int i = 0; i < 64; ++i) {
        const ivec3 voxel = low + ivec3(i & 3, i >> 2 & 3, i >> 4);
        const uint cell = view_grid_cell(grid_low, grid_size, voxel >> int(params.edge_shift));
        const uint record = find_record(cell, voxel_number(voxel, params.edge_shift));
        if (record == kNoRecord) continue;
        const uvec4 its = PACKED(record);
        const vec3 away = point.at_vox - vec3(voxel);
        const bool same = same_surface(point, away, packed_surface(its)) > 0.0;
        const float distance2 = dot(away, away) + (same ? 0.0 : kOtherSurface2);
        if (distance2 < nearest && packed_certainty(its) != vec3(0.0)) {
            nearest = distance2;
            content = its;
            chosen = record;
        }
        if (distance2 < nearest_label && packed_has_label(its)) {
            nearest_label = distance2;
            found.labelled = record;
        }
    }
    if (chosen == kNoRecord) return found;
    float marched = 0.0;
    [[unroll]] for (int i = 0; i < 8; ++i) marched += share_of[i];
    if (marched == 0.0) {
        near_record[0] = chosen;
        share_of[0] = 1.0;
        visible_from[0] = uvec2(content.w, 0u);
    }
    return Reflectance(packed_kd(content), packed_certainty(content), true, packed_surface(content).xyz,
                       found.labelled);
}

// What the records do not know, or not surely, is what the rest of their segment has.
Reflectance with_segment(Reflectance found, vec4 segment, vec3 normal) {
    const float weight = segment.a * kSegmentWeight;
    const vec3 kd = (found.weights * found.kd + weight * segment.rgb) / max(found.weights + weight, 1e-20);
    return Reflectance(kd, found.weights, found.known || segment.a > 0.0, found.known ? found.normal : normal,
                       found.labelled);
}

// Makes the shares sum to 1. Where no light was marched yet, every light reaches the point.
void normalise_shares() {
    float all = 0.0;
    [[unroll]] for (int i = 0; i < 8; ++i) all += share_of[i];
    if (all == 0.0) {
        share_of[0] = 1.0;
        visible_from[0] = uvec2(0xffffffffu);
        return;
    }
    [[unroll]] for (int i = 0; i < 8; ++i) share_of[i] /= all;
}

// The share of the surface around the point that a light reaches.
float share_lit(uint light) {
    float lit = 0.0;
    [[unroll]] for (int i = 0; i < 8; ++i) {
        const uint bits = light < 32u ? visible_from[i].x : visible_from[i].y;
        lit += (bits >> (light & 31u) & 1u) != 0u ? share_of[i] : 0.0;
    }
    return params.shadows == 0u ? 1.0 : lit;
}

void load_further_visibility() {
    [[unroll]] for (int i = 0; i < 8; ++i) visible_from[i].y = visibility[near_record[i]].y;
}

vec3 radiance(vec3 point_m, vec3 normal, vec3 to_viewer, vec3 kd, vec4 gloss) {
    vec3 sum = header.ambient.rgb * kd;
    const uint count = header.count;
    for (uint i = 0u; i < count; ++i) {
        sum += share_lit(i) * ward_point_light(kd, gloss.rgb, max(gloss.w, kLeastAlpha), normal,
                                               lights[i].position_m.xyz - point_m, lights[i].intensity.rgb, to_viewer);
    }
    return sum;
}

// The normal of a pixel, smoothed by those of the four beside it as far as they agree: the model's is the gradient of
// one voxel cell, which is noisy. Outside the image there is none: images read zero there.
vec3 smooth_normal(ivec2 pixel) {
    const ivec2 sides[4] = ivec2[](ivec2(-1, 0), ivec2(1, 0), ivec2(0, -1), ivec2(0, 1));
    const vec3 own = imageLoad(normal, pixel).xyz;
    vec3 sum = own * (1.0 - kCreaseCosine);
    [[unroll]] for (int i = 0; i < 4; ++i) {
        const vec3 beside = imageLoad(normal, pixel + sides[i]).xyz;
        sum += beside * max(dot(own, beside) - kCreaseCosine, 0.0);
    }
    return own == vec3(0.0) ? own : normalize(sum);
}

void main() {
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(position_m)))) return;
    grid_low = view.grid_low.xyz;
    grid_size = view.grid_size.xyz;
    const vec4 hit = imageLoad(position_m, pixel);
    vec4 known_kd = vec4(0.0), gloss = vec4(0.0), shaded = vec4(0.0);
    uint segment = 0u;
    if (hit.w > 0.0) {
        const SurfacePoint point = SurfacePoint(hit.xyz / params.voxel_m - 0.5, smooth_normal(pixel),
                                                normalize(camera_center_m(view.camera) - hit.xyz));
        Reflectance found = interpolate(point);
        if (!found.known) found = fill(point, found);
        segment = found.labelled == kNoRecord ? 0u : record_label(records[found.labelled]);
        const bool has_entry = segment != 0u && segment < params.materials;
        gloss = has_entry ? materials[segment].ks_alpha : vec4(0.0);
        found = with_segment(found, has_entry ? segment_kd(segments[segment]) : vec4(0.0), point.to_viewer);
        if (found.known) {
            if (header.count > 32u) load_further_visibility();
            normalise_shares();
            const vec3 facing = normalize(point.normal != vec3(0.0) ? point.normal : found.normal);
            known_kd = vec4(found.kd, 1.0);
            shaded = vec4(radiance(hit.xyz, facing, point.to_viewer, found.kd, gloss), 1.0);
        }
    }
    imageStore(kd, pixel, known_kd);
    imageStore(label, pixel, uvec4(segment));
    imageStore(ks_alpha, pixel, gloss);
    imageStore(rgb, pixel, shaded);
}
