#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// The normal of each surface point: the mean over the points around it that lie on one plane with it. Beside an edge,
// where the volume's gradient passes from one face to the other over about a voxel, it is that of the face on whose
// plane most of the points around lie; of a flat face, whose points farther off have one normal, before all others.
#include "shared/fusion/sharpen_normals.h"

layout(local_size_x = kSharpenGroup, local_size_y = kSharpenGroup) in;
layout(binding = 0, rgba32f) uniform readonly image2D position_m;
layout(binding = 1, rgba16f) uniform readonly image2D normal;
layout(binding = 2, rgba16f) uniform writeonly image2D sharp_normal;
layout(push_constant) uniform Push { SharpenNormalsParams params; };

const int kTaps = 8;
const float kReachVox = 1.5;        // of the taps
const float kOnPlaneShare = 0.35;   // of their distance: farther from a plane is not on it
const float kEvenCosine = 0.7;      // 45 degrees: normals that differ by less around a point are a curved face's
const float kSameCosine = 0.94;     // 20 degrees: those that differ by more are not averaged,
const float kRoughCosine = 0.5;     // or by more than 60, where the surface is rough,
const float kRoughPlane = 3.0;      // and so many times as far off the plane
const float kRoughSupport = 2.0;    // points that agree with the normal: it is rough with no more,
const float kEvenSupport = 4.0;     // and even with as many
const float kFaceSupport = 2.0;     // points that a face has at least,
const float kOwnSupport = 0.5;      // and more than the plane of the gradient's own normal
const float kFlatReachVox = 5.0;    // of the points that tell a flat face from a curved one
const float kFlatOffVox = 0.25;     // how far off their plane they are at most,
const float kFlatOffShare = 0.02;   // and this share of their distance
const float kFlatCosine = 0.998;    // 3.6 degrees: their normals are one
const uint kFlatSupport = 3u;       // points that a flat face has at least
const float kUnbentCosine = 0.999;  // 2.6 degrees: a normal like those around it needs no other

struct Ring {
    bool hit[kTaps];      // there is a point
    vec3 around[kTaps];   // where it is, from the pixel's own
    vec3 normals[kTaps];  // 0: not known
};

int pixels_of(float reach_vox, float depth_m) {
    return max(int(reach_vox * params.voxel_m * params.focal_px / max(depth_m, 1e-3) + 0.5), 1);
}

Ring look_around(ivec2 pixel, vec3 own_m, int reach) {
    const int diagonal = (7 * reach + 5) / 10;
    const ivec2 taps[kTaps] = ivec2[](ivec2(reach, 0), ivec2(diagonal), ivec2(0, reach), ivec2(-diagonal, diagonal),
                                      ivec2(-reach, 0), ivec2(-diagonal), ivec2(0, -reach), ivec2(diagonal, -diagonal));
    Ring ring;
    [[unroll]] for (int i = 0; i < kTaps; ++i) {
        const vec4 there = imageLoad(position_m, pixel + taps[i]);  // zero outside the image
        ring.hit[i] = there.w > 0.0;
        ring.around[i] = there.xyz - own_m;
        ring.normals[i] = imageLoad(normal, pixel + taps[i]).xyz;
    }
    return ring;
}

float least_cosine(Ring ring, vec3 own) {
    float least = 1.0;
    [[unroll]] for (int i = 0; i < kTaps; ++i) least = min(least, dot(ring.normals[i], own));
    return least;
}

// How many of the points around lie on the plane through the pixel's own.
float support_of(Ring ring, vec3 facing, float on_plane_m) {
    float sum = 0.0;
    [[unroll]] for (int i = 0; i < kTaps; ++i) {
        const float off = dot(facing, ring.around[i]) / on_plane_m;
        sum += ring.hit[i] ? max(1.0 - off * off, 0.0) : 0.0;
    }
    return sum;
}

// The normal of the face that most of the points around lie on; `own` unless another has clearly more of them.
vec3 best_face(Ring ring, vec3 own, float on_plane_m) {
    float most = own == vec3(0.0) ? 0.0 : max(support_of(ring, own, on_plane_m) + kOwnSupport, kFaceSupport);
    vec3 best = own;
    [[unroll]] for (int i = 0; i < kTaps; ++i) {
        const vec3 candidate = ring.normals[i];
        const bool on_plane = ring.hit[i] && abs(dot(candidate, ring.around[i])) < on_plane_m;
        const float support = candidate != vec3(0.0) && on_plane ? support_of(ring, candidate, on_plane_m) : 0.0;
        best = support > most ? candidate : best;
        most = max(support, most);
    }
    return best;
}

bool on_flat_face(Ring ring, int i, vec3 facing) {
    const float off_m = kFlatOffVox * params.voxel_m + kFlatOffShare * length(ring.around[i]);
    return ring.hit[i] && abs(dot(facing, ring.around[i])) < off_m && dot(facing, ring.normals[i]) > kFlatCosine;
}

uint flat_support_of(Ring ring, vec3 facing) {
    uint count = 0u;
    [[unroll]] for (int i = 0; i < kTaps; ++i) count += on_flat_face(ring, i, facing) ? 1u : 0u;
    return count;
}

// The normal of the flat face through the point that most of the points farther off lie on; `face` where there is none
// or where the point's own normal has as many. a: 1 where there is one.
vec4 flat_face(Ring ring, vec3 own, vec3 face) {
    uint most = max(flat_support_of(ring, own), kFlatSupport - 1u);
    vec3 best = face;
    [[unroll]] for (int i = 0; i < kTaps; ++i) {
        const vec3 candidate = ring.normals[i];
        const uint support = on_flat_face(ring, i, candidate) ? flat_support_of(ring, candidate) : 0u;
        best = support > most ? candidate : best;
        most = max(support, most);
    }
    return vec4(best, most >= kFlatSupport ? 1.0 : 0.0);
}

bool on_face(Ring ring, int i, vec3 face, float on_plane_m) {
    return ring.hit[i] && abs(dot(face, ring.around[i])) < on_plane_m;
}

// 1: the surface is rough: few of the normals around agree with the face's.
float roughness_of(Ring ring, vec3 face, float on_plane_m) {
    float support = 0.0;
    [[unroll]] for (int i = 0; i < kTaps; ++i) support +=
        on_face(ring, i, face, on_plane_m) && dot(ring.normals[i], face) > kSameCosine ? 1.0 : 0.0;
    return 1.0 - smoothstep(kRoughSupport, kEvenSupport, support);
}

// The mean of a face's normal and those of the points around on its plane.
vec3 smooth_over(Ring ring, vec3 face, float rough, float on_plane_m) {
    const float least = mix(kSameCosine, kRoughCosine, rough), off_m = mix(1.0, kRoughPlane, rough) * on_plane_m;
    vec3 sum = face;
    [[unroll]] for (int i = 0; i < kTaps; ++i) {
        const float agreement = max(dot(ring.normals[i], face) - least, 0.0) / (1.0 - least);
        sum += on_face(ring, i, face, off_m) ? agreement * ring.normals[i] : vec3(0.0);
    }
    return normalize(sum);
}

void main() {
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(position_m)))) return;
    const vec4 hit = imageLoad(position_m, pixel);
    const vec3 own = imageLoad(normal, pixel).xyz;
    const int reach = pixels_of(kReachVox, hit.w);
    const float on_plane_m = kOnPlaneShare * float(reach) * max(hit.w, 1e-3) / params.focal_px;
    const Ring near = look_around(pixel, hit.xyz, reach);
    const float least = least_cosine(near, own);
    vec3 face = own;
    float is_flat = 0.0;
    if (least < kEvenCosine && hit.w > 0.0) face = best_face(near, own, on_plane_m);
    if (least < kUnbentCosine && hit.w > 0.0) {
        const Ring far = look_around(pixel, hit.xyz, max(pixels_of(kFlatReachVox, hit.w), reach + 1));
        const vec4 found = flat_face(far, own, face);
        face = found.xyz;
        is_flat = found.a;
    }
    const float rough = (1.0 - is_flat) * roughness_of(near, face, on_plane_m);
    imageStore(sharp_normal, pixel, vec4(face == vec3(0.0) ? face : smooth_over(near, face, rough, on_plane_m), 0.0));
}
