#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// The normal of each surface point: the mean over the points around it that lie on one plane with it. Beside an edge,
// where the volume's gradient passes from one face to the other over about a voxel, it is that of the face on whose
// plane most of the points around lie.
#include "shared/sharpen_normals.h"

layout(local_size_x = kSharpenGroup, local_size_y = kSharpenGroup) in;
layout(binding = 0, rgba32f) uniform readonly image2D position_m;
layout(binding = 1, rgba16f) uniform readonly image2D normal;
layout(binding = 2, rgba16f) uniform writeonly image2D sharp_normal;
layout(push_constant) uniform Push { SharpenNormalsParams params; };

const int kTaps = 8;
const float kReachVox = 1.5;       // of the taps
const float kOnPlaneShare = 0.35;  // of their distance: farther from a plane is not on it
const float kEvenCosine = 0.7;     // 45 degrees: normals that differ by less around a point are a curved face's
const float kSameCosine = 0.94;    // 20 degrees: those that differ by more are not averaged
const float kFaceSupport = 2.0;    // points that a face has at least,
const float kOwnSupport = 0.5;     // and more than the plane of the gradient's own normal

vec3 around[kTaps];   // where the points are, from the pixel's own; far away: there is none
vec3 normals[kTaps];  // 0: not known
float on_plane_m;

// How many of the points around lie on the plane through the pixel's own.
float support_of(vec3 facing) {
    float sum = 0.0;
    [[unroll]] for (int i = 0; i < kTaps; ++i) {
        const float off = dot(facing, around[i]) / on_plane_m;
        sum += max(1.0 - off * off, 0.0);
    }
    return sum;
}

// The normal of the face that most of the points around lie on; `own` unless another has clearly more of them.
vec3 best_face(vec3 own) {
    float most = own == vec3(0.0) ? 0.0 : max(support_of(own) + kOwnSupport, kFaceSupport);
    vec3 best = own;
    [[unroll]] for (int i = 0; i < kTaps; ++i) {
        const bool on_plane = abs(dot(normals[i], around[i])) < on_plane_m;
        const float support = normals[i] != vec3(0.0) && on_plane ? support_of(normals[i]) : 0.0;
        best = support > most ? normals[i] : best;
        most = max(support, most);
    }
    return best;
}

void main() {
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(position_m)))) return;
    const vec4 hit = imageLoad(position_m, pixel);
    const vec3 own = imageLoad(normal, pixel).xyz;
    const int reach = max(int(kReachVox * params.voxel_m * params.focal_px / max(hit.w, 1e-3) + 0.5), 1);
    on_plane_m = kOnPlaneShare * float(reach) * max(hit.w, 1e-3) / params.focal_px;
    const int diagonal = int(0.7 * float(reach) + 0.5);
    const ivec2 taps[kTaps] = ivec2[](ivec2(reach, 0), ivec2(diagonal), ivec2(0, reach), ivec2(-diagonal, diagonal),
                                      ivec2(-reach, 0), ivec2(-diagonal), ivec2(0, -reach), ivec2(diagonal, -diagonal));
    bool even = true;
    [[unroll]] for (int i = 0; i < kTaps; ++i) {
        const vec4 there = imageLoad(position_m, pixel + taps[i]);  // zero outside the image
        around[i] = there.w > 0.0 ? there.xyz - hit.xyz : vec3(1e6);
        normals[i] = imageLoad(normal, pixel + taps[i]).xyz;
        even = even && dot(normals[i], own) >= kEvenCosine;
    }
    vec3 face = own;
    if (!even && hit.w > 0.0) face = best_face(own);
    vec3 sum = face;
    [[unroll]] for (int i = 0; i < kTaps; ++i) {
        const bool on_plane = abs(dot(face, around[i])) < on_plane_m;
        const float agreement = max(dot(normals[i], face) - kSameCosine, 0.0) * (1.0 / (1.0 - kSameCosine));
        sum += on_plane ? agreement * normals[i] : vec3(0.0);
    }
    imageStore(sharp_normal, pixel, vec4(face == vec3(0.0) ? face : normalize(sum), 0.0));
}
