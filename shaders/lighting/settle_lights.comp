// The answer for each light: medians over its sightings; without depth, the point nearest to all bearings. A lamp whose
// size in the pictures goes with the cosine to an axis is flat.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "core_bulge.glsl"
#include "lib/color/luminance.glsl"
#include "lib/math/cone.glsl"
#include "shared/lighting/find_lights.h"

layout(local_size_x = kMaxSightings) in;
layout(std430, binding = 0) readonly buffer Tracks { LightTrack tracks[]; };
layout(std430, binding = 1) readonly buffer History { LightSighting history[]; };
layout(std430, binding = 2) writeonly buffer Found { FoundLight found[]; };

// Bearings closer together than this cannot tell a distance: 3 degrees, where an error of a pixel is some 5 %.
const float kLeastParallax = 0.05;

// The image of another lamp in a mirror, which is none: it moves with the camera as far as the distances of both from
// it ask for, and the half vector of the ways to the camera and to that lamp stays. A lamp stays itself, and its half
// vector turns by half as much as the way to the camera, or more.
const float kLeastTurn = 0.02;  // of the way to the camera, from which on sightings tell
const float kImageTurn = 0.4;   // of the half vector, over that
const float kImageMove = 0.6;   // over what an image's would be

// A flat lamp looks smaller from aside, and its intensity there is less.
const float kSizeNoise = 0.1;    // of an intensity, relative: a lamp is few pixels wide
const float kLeastChange = 0.2;  // mean robust cost of sightings of one intensity, from which on it is none
const float kFlatCost = 0.4;     // that of a flat lamp over that
const uint kAxisSteps = 6u;      // of reweighting
const float kRidge = 0.0025;     // of the normal equations: what no sighting tells of an axis is 0
const uint kLeastOfFlat = 6u;    // sightings, as an axis has three unknowns
const float kMostOfFlat = 5.0;   // intensity along the axis, over what is seen: a trend of errors would ask for more
const float kLeastFacing = 0.1;  // cosine: a flat lamp is hardly seen from farther aside

shared float values[kMaxSightings];
shared vec3 directions[kMaxSightings];  // to the cameras
shared float strengths[kMaxSightings];  // intensities over their median
shared vec4 flat_lamp;                  // xyz: axis, w: intensity over the median; w 0: it is none
shared float middle;
shared vec4 triangulated;  // w: 1 when there is a point
shared uint is_image;

// The lower median of the values that the first `count` invocations hold.
float median(float own, uint count) {
    const uint lane = gl_LocalInvocationIndex;
    values[lane] = own;
    barrier();
    uint rank = 0u;
    for (uint i = 0u; i < count; ++i) rank += uint(values[i] < own || (values[i] == own && i < lane));
    if (lane < count && rank == (count - 1u) / 2u) middle = own;
    barrier();
    const float result = middle;
    barrier();
    return result;
}

vec3 median(vec3 own, uint count) { return vec3(median(own.x, count), median(own.y, count), median(own.z, count)); }

// Least squares: the sum of (1 - b b^T) (x - c) over all cameras c and bearings b is zero.
void triangulate(uint light, uint count) {
    mat3 normal = mat3(0.0);
    vec3 right = vec3(0.0);
    float parallax = 0.0;
    const uint first = light * kMaxSightings;
    const vec3 origin_m = history[first].camera_m.xyz;
    for (uint i = 0u; i < count; ++i) {
        const vec3 b = history[first + i].bearing.xyz;
        const mat3 across = mat3(1.0) - outerProduct(b, b);
        normal += across;
        right += across * (history[first + i].camera_m.xyz - origin_m);
        parallax = max(parallax, distance(b, history[first].bearing.xyz));
    }
    const bool enough = parallax >= kLeastParallax;
    triangulated = enough ? vec4(origin_m + inverse(normal) * right, 1.0) : vec4(0.0);
}

// The point of its surface that faces the camera.
vec3 front_m(LightSighting s) {
    return s.center_radius.xyz + s.center_radius.w * normalize(s.camera_m.xyz - s.center_radius.xyz);
}

vec3 to_camera(LightSighting s) { return normalize(s.camera_m.xyz - s.center_radius.xyz); }

// Between the ways to the camera and to another light: the normal of a mirror that shows it here.
vec3 half_vector(LightSighting s, vec3 other_m) { return normalize(to_camera(s) + normalize(other_m - front_m(s))); }

// Whether the sightings of a light are images of another one in a plane mirror.
bool is_image_of(uint light, uint count, uint other) {
    vec3 view = vec3(0.0), middle_way = vec3(0.0), place_m = vec3(0.0);
    for (uint i = 0u; i < count; ++i) {
        const LightSighting s = history[light * kMaxSightings + i];
        view += to_camera(s) / float(count);
        middle_way += half_vector(s, tracks[other].place.xyz) / float(count);
        place_m += s.center_radius.xyz / float(count);
    }
    float view_turns = 0.0, middle_turns = 0.0, moves_m = 0.0, reach_m = 0.0;
    for (uint i = 0u; i < count; ++i) {
        const LightSighting s = history[light * kMaxSightings + i];
        view_turns += distance(view, to_camera(s)) / float(count);
        middle_turns += distance(middle_way, half_vector(s, tracks[other].place.xyz)) / float(count);
        moves_m += distance(place_m, s.center_radius.xyz) / float(count);
        reach_m += distance(s.camera_m.xyz, place_m) / float(count);
    }
    const float other_m = distance(place_m, tracks[other].place.xyz);
    const float image_moves_m = view_turns * reach_m * other_m / (other_m + reach_m);
    return view_turns > kLeastTurn && middle_turns < kImageTurn * view_turns && moves_m > kImageMove * image_moves_m;
}

// Geman and McClure's cost of a relative residual, and its weight.
float cost_of(float residual) {
    const float squared = residual * residual / (kSizeNoise * kSizeNoise);
    return squared / (1.0 + squared);
}

float weight_of(float residual) {
    const float share = 1.0 - cost_of(residual);
    return share * share;
}

// By iteratively reweighted least squares: strength = dot(axis * intensity, direction).
vec4 fit_flat_lamp(uint count) {
    vec3 fitted = vec3(0.0);
    for (uint step = 0u; step < kAxisSteps; ++step) {
        mat3 normal = mat3(kRidge);
        vec3 right = vec3(0.0);
        for (uint i = 0u; i < count; ++i) {
            const vec3 d = directions[i];
            const float weight = step == 0u ? 1.0 : weight_of(strengths[i] - dot(fitted, d));
            normal += weight * outerProduct(d, d);
            right += weight * strengths[i] * d;
        }
        fitted = inverse(normal) * right;
    }
    float of_one = 0.0, of_flat = 0.0;
    for (uint i = 0u; i < count; ++i) {
        of_one += cost_of(strengths[i] - 1.0) / float(count);
        of_flat += cost_of(strengths[i] - max(dot(fitted, directions[i]), 0.0)) / float(count);
    }
    const float free = float(count) / max(float(count) - 3.0, 1.0), strength = length(fitted);
    const bool is_flat = count >= kLeastOfFlat && strength > 0.0 && strength < kMostOfFlat && of_one > kLeastChange &&
                         free * of_flat < kFlatCost * of_one;
    return is_flat ? vec4(fitted / strength, strength) : vec4(0.0);
}

void main() {
    const uint lane = gl_LocalInvocationIndex, light = gl_WorkGroupID.x;
    const LightTrack track = tracks[light];
    const uint count = min(track.sightings, kMaxSightings);
    const LightSighting s = history[light * kMaxSightings + min(lane, max(count, 1u) - 1u)];
    const bool has_depth = track.has_depth != 0u;
    if (lane == 0u) {
        triangulated = vec4(0.0);
        middle = 0.0;
        is_image = 0u;
        if (!has_depth && count > 1u) triangulate(light, count);
    }
    barrier();
    for (uint other = lane; has_depth && other < kMaxLights; other += kMaxSightings) {
        const bool is_lamp = other != light && tracks[other].sightings > 0u && tracks[other].has_depth != 0u;
        if (is_lamp && is_image_of(light, count, other)) atomicOr(is_image, 1u);
    }
    barrier();
    const vec3 on_sphere_m = has_depth ? median(s.center_radius.xyz, count) : triangulated.xyz;
    const float range_m = distance(has_depth ? s.center_radius.xyz : on_sphere_m, s.camera_m.xyz);
    const vec3 intensities = has_depth ? s.intensity.rgb : s.intensity.rgb * range_m * range_m;
    const float usual = median(luminance(intensities), count);
    if (lane < count) {
        directions[lane] = normalize(s.camera_m.xyz - on_sphere_m);
        strengths[lane] = luminance(intensities) / max(usual, 1e-30);
    }
    barrier();
    // Where pixels are clipped, those of the rim count as much as others, and sizes err.
    if (lane == 0u) flat_lamp = 2u * track.clipped < track.sightings ? fit_flat_lamp(count) : vec4(0.0);
    barrier();
    const bool is_flat = flat_lamp.w > 0.0;
    // As large and as bright as it looks from straight before it, and where its disc is.
    const float sphere_m = has_depth ? s.center_radius.w : range_m * sine_of_cone(s.bearing.w);
    // Depth on it is that of its middle, which measure_emitters.comp takes for the front of a sphere.
    const float nearer = is_flat && has_depth ? 1.0 - kCoreBulge * sphere_m / range_m : 1.0;
    const vec3 to_viewer = normalize(s.camera_m.xyz - on_sphere_m);
    const float facing = is_flat ? max(dot(flat_lamp.xyz, to_viewer), kLeastFacing) : 1.0;
    const vec3 disc_m = s.camera_m.xyz + nearer * (s.center_radius.xyz - s.camera_m.xyz);
    const vec3 position_m = is_flat && has_depth ? median(disc_m, count) : on_sphere_m;
    const vec3 intensity = median(intensities * nearer * nearer / facing, count);
    const float radius_m = median(sphere_m * nearer * inversesqrt(facing), count);
    const vec3 off_m = position_m - s.camera_m.xyz;
    const float miss_m = length(cross(off_m, s.bearing.xyz));
    const float spread_m =
        median(has_depth ? distance(is_flat ? disc_m : s.center_radius.xyz, position_m) : miss_m, count);
    if (lane != 0u) return;
    const bool found_one = count > 0u && (has_depth || triangulated.w > 0.0) && is_image == 0u;
    found[light] = FoundLight(
        PointLight(vec4(position_m, radius_m), vec4(intensity, 0.0), vec4(flat_lamp.xyz, is_flat ? 0.0 : 1.0)),
        spread_m, found_one ? track.sightings : 0u, track.has_depth, track.clipped);
}
