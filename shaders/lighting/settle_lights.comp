// The answer for each light: medians over its sightings; without depth, the point nearest to all bearings.
#version 460
#extension GL_GOOGLE_include_directive : require
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

shared float values[kMaxSightings];
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
    const vec3 position_m = has_depth ? median(s.center_radius.xyz, count) : triangulated.xyz;
    const float distance_m = distance(position_m, s.camera_m.xyz);
    const vec3 intensity = median(has_depth ? s.intensity.rgb : s.intensity.rgb * distance_m * distance_m, count);
    const float radius_m = median(has_depth ? s.center_radius.w : distance_m * sine_of_cone(s.bearing.w), count);
    const vec3 off_m = position_m - s.camera_m.xyz;
    const float miss_m = length(cross(off_m, s.bearing.xyz));
    const float spread_m = median(has_depth ? distance(s.center_radius.xyz, position_m) : miss_m, count);
    if (lane != 0u) return;
    const bool found_one = count > 0u && (has_depth || triangulated.w > 0.0) && is_image == 0u;
    found[light] = FoundLight(PointLight(vec4(position_m, radius_m), vec4(intensity, 0.0), vec4(0.0, 0.0, 0.0, 1.0)),
                              spread_m, found_one ? track.sightings : 0u, track.has_depth, track.clipped);
}
