// The diffuse albedo and the segment between the records around a surface point (paper, Section 3.7). How records are
// found is the includer's. Functions without bindings.
#ifndef PATINA_LIB_BLEND_RECORDS_GLSL
#define PATINA_LIB_BLEND_RECORDS_GLSL
#include "lib/records/packed_records.glsl"

// A record belongs to the surface point's own surface where their normals agree and its tangent plane passes near the
// point. Between the two values the weight falls linearly.
const float kAgreeingCosine = 0.75;
const float kOtherCosine = 0.25;
const float kOnPlaneVox = 0.5;
const float kOffPlaneVox = 1.0;
const float kLeastWeight = 1e-6;     // trilinear shares below it are none
const float kOtherSurface2 = 100.0;  // added to squared distances: what is of another surface comes last
const float kOpposedCosine = -0.5;   // below it a surface is the back of something thin, and tells nothing
const float kNowhere2 = 1e9;         // farther than every record, squared

struct SurfacePoint {
    vec3 at_vox;  // in voxels of the observations, whose centres are at integers
    vec3 normal;  // 0 where it is not known
    vec3 to_viewer;
};

// Between the point's normal and a record's. Where the model has no normal, all that faces the viewer agrees, and
// nothing else.
float cosine_with(SurfacePoint point, vec3 normal) {
    if (point.normal != vec3(0.0)) return dot(point.normal, normal);
    return dot(point.to_viewer, normal) > 0.0 ? 1.0 : -1.0;
}

// How much the surface of a record is that of the point, 0 to 1; `surface` is packed_surface, `away_vox` leads from the
// record's voxel to the point.
float same_surface(SurfacePoint point, vec3 away_vox, vec4 surface) {
    const float cosine = cosine_with(point, surface.xyz);
    const float off = abs(dot(surface.xyz, away_vox) - surface.w);
    return clamp((cosine - kOtherCosine) / (kAgreeingCosine - kOtherCosine), 0.0, 1.0) *
           clamp((kOffPlaneVox - off) / (kOffPlaneVox - kOnPlaneVox), 0.0, 1.0);
}

struct Reflectance {
    vec3 kd;       // of records alone, as much as their light asks for (albedo_raw_kd)
    vec4 around;   // the albedo of the surface around; a: 1 where it is known
    vec3 weights;  // of kd's channels, 1 where all records that there are are certain
    bool known;
    vec3 normal;    // of the records
    uint labelled;  // the nearest record with a label, or kNoRecord
};

// The mean over records of the point's surface while it is summed up.
struct RecordSums {
    vec3 kd, weights, normals;
    vec4 around;
    float shares;
    float nearest2;  // of those with a label
    uint labelled;
};
RecordSums no_records() { return RecordSums(vec3(0.0), vec3(0.0), vec3(0.0), vec4(0.0), 0.0, kNowhere2, kNoRecord); }

// Adds a record, or kNoRecord with any content; `around`: the albedo of the surface around it, shared exponent, 0 where
// it is not known; `share` is its trilinear part. Returns its weight, 0 where it is of another surface.
float add_record(inout RecordSums sums, SurfacePoint point, uint record, uvec4 content, uint around, vec3 away_vox,
                 float share) {
    const vec4 surface = packed_surface(content);
    const float same = record != kNoRecord ? same_surface(point, away_vox, surface) : 0.0;
    const float weight = same * max(share, kLeastWeight);
    const vec3 certain = weight * packed_certainty(content);
    sums.kd += certain * packed_raw_kd(content);
    sums.weights += certain;
    sums.around += around != 0u ? weight * vec4(unpack_shared_exponent(around), 1.0) : vec4(0.0);
    sums.shares += weight;
    sums.normals += weight * surface.xyz;
    const float distance2 = same > 0.0 && packed_has_label(content) ? dot(away_vox, away_vox) : kNowhere2;
    sums.labelled = distance2 < sums.nearest2 ? record : sums.labelled;
    sums.nearest2 = min(distance2, sums.nearest2);
    return weight;
}

Reflectance mean_of(RecordSums sums) {
    const bool known = max(max(sums.weights.r, sums.weights.g), sums.weights.b) > 0.0;
    const vec4 around = sums.around.a > 0.0 ? vec4(sums.around.rgb / sums.around.a, 1.0) : vec4(0.0);
    return Reflectance(sums.kd / max(sums.weights, 1e-20), around, sums.weights / max(sums.shares, 1e-20), known,
                       sums.normals, sums.labelled);
}

// The nearest records of the point's surface: that which knows kd, and that with a label.
struct NearestRecords {
    float known2, labelled2;
    uint known, labelled;
};
NearestRecords nearest_after(Reflectance found) {
    return NearestRecords(kNowhere2, found.labelled == kNoRecord ? kNowhere2 : -1.0, kNoRecord, found.labelled);
}

// Looks at a record, or at kNoRecord with any content. Without branches, which cost software devices both sides.
void look_at_record(inout NearestRecords nearest, SurfacePoint point, uint record, uvec4 content, vec3 away_vox) {
    const vec4 surface = packed_surface(content);
    const bool same = same_surface(point, away_vox, surface) > 0.0;
    const bool tells = record != kNoRecord && cosine_with(point, surface.xyz) > kOpposedCosine;
    const float distance2 = tells ? dot(away_vox, away_vox) + (same ? 0.0 : kOtherSurface2) : kNowhere2;
    const float known2 = packed_is_known(content) ? distance2 : kNowhere2;
    const float labelled2 = packed_has_label(content) ? distance2 : kNowhere2;
    nearest.known = known2 < nearest.known2 ? record : nearest.known;
    nearest.known2 = min(known2, nearest.known2);
    nearest.labelled = labelled2 < nearest.labelled2 ? record : nearest.labelled;
    nearest.labelled2 = min(labelled2, nearest.labelled2);
}

// What the nearest records fill in for a point that knows nothing; `content` is that of nearest.known, if any.
Reflectance filled(Reflectance found, NearestRecords nearest, uvec4 content) {
    found.labelled = nearest.labelled;
    if (nearest.known == kNoRecord) return found;
    return Reflectance(packed_raw_kd(content), vec4(0.0), packed_certainty(content), true, packed_surface(content).xyz,
                       nearest.labelled);
}

// What the records do not know, or not surely, is what the surface around has, or the rest of their segment;
// `segment` is segment_kd.
Reflectance with_segment(Reflectance found, vec4 segment, vec3 normal) {
    const bool alike = found.around.a > 0.0;
    const vec4 others = alike ? found.around : segment;
    const float deviation = alike ? kSurfaceDeviation : kTextureDeviation;
    // Certainty is 1 / (1 + variance), in units of kKdDeviation squared.
    const vec3 sureness = found.weights / max(1.0 - found.weights, 1e-3);
    const float weight = others.a * kKdDeviation * kKdDeviation / (deviation * deviation);
    const vec3 kd = (sureness * min(found.kd, 1.0) + weight * others.rgb) / max(sureness + weight, 1e-20);
    return Reflectance(kd, found.around, found.weights, found.known || others.a > 0.0,
                       found.known ? found.normal : normal, found.labelled);
}

#endif
