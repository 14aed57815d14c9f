// Measures a candidate: where its centre is, how large it appears, how bright it is.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "core_bulge.glsl"
#include "lib/camera/camera.glsl"
#include "lib/color/luminance.glsl"
#include "lib/math/cone.glsl"
#include "shared/lighting/find_lights.h"
#include "sum_of_group.glsl"

layout(local_size_x = kMeanShiftGroup) in;
layout(std140, binding = 0) uniform Params { FindLightsParams params; };
layout(std430, binding = 1) readonly buffer Places { uint places[]; };
layout(std430, binding = 2) readonly buffer Emitters { Emitter emitters[]; };
layout(std430, binding = 3) readonly buffer Candidates { EmitterMode candidates[]; };
layout(std430, binding = 4) writeonly buffer Sightings { LightSighting sightings[]; };

shared uint flags_of_group;

// Whether an emitter's depth says that it belongs to another candidate. Without depth, or with one between two
// surfaces, its bearing alone decides.
bool is_of_another(Emitter e, uint candidate, vec3 camera_m) {
    if (e.bearing_range.w == 0.0) return false;
    const vec3 point_m = camera_m + e.bearing_range.w * e.bearing_range.xyz;
    if (distance(point_m, candidates[candidate].point.xyz) <= candidates[candidate].reach) return false;
    for (uint k = 0u; k < kMaxLightCandidates && candidates[k].weight > 0.0; ++k) {
        if (candidates[k].has_depth != 0u && distance(point_m, candidates[k].point.xyz) <= candidates[k].reach)
            return true;
    }
    return false;
}

// Whether a heavier candidate's kernel grew over this one.
bool is_covered(uint candidate) {
    const EmitterMode mode = candidates[candidate];
    for (uint k = 0u; k < candidate; ++k) {
        const bool alike = candidates[k].has_depth == mode.has_depth;
        if (alike && distance(candidates[k].point.xyz, mode.point.xyz) <= candidates[k].reach) return true;
    }
    return false;
}

void main() {
    const uint lane = gl_LocalInvocationIndex, candidate = gl_WorkGroupID.x;
    const EmitterMode mode = candidates[candidate];
    const uint count = mode.weight > 0.0 ? min(places[params.group_count], kMaxEmitters) : 0u;
    const bool has_depth = mode.has_depth != 0u;
    const vec3 camera_m = camera_center_m(params.camera);
    const vec3 toward = has_depth ? normalize(mode.point.xyz - camera_m) : mode.point.xyz;
    const float reach = has_depth ? mode.reach / max(distance(mode.point.xyz, camera_m), mode.reach) : mode.reach;
    if (lane == 0u) flags_of_group = 0u;
    barrier();

    // All that shines around the bearing.
    vec4 light = vec4(0.0), pull = vec4(0.0);
    for (uint k = lane; k < count; k += kMeanShiftGroup) {
        const Emitter e = emitters[k];
        if (distance(e.bearing_range.xyz, toward) > reach || is_of_another(e, candidate, camera_m)) continue;
        const float angle_sr = e.radiance_angle.w;
        const float mass = angle_sr * luminance(e.radiance_angle.rgb);
        light += vec4(e.radiance_angle.rgb, 1.0) * angle_sr;
        pull += vec4((e.bearing_range.xyz - toward) * mass, mass);
        if (e.flags != 0u) atomicOr(flags_of_group, e.flags);
    }
    light = sum_of_group(light);
    pull = sum_of_group(pull);
    const vec3 bearing = normalize(toward + pull.xyz / max(pull.w, 1e-30));

    // Its middle: radiance without the rim's mixed pixels, and the distance to the surface.
    const float edge = sqrt(max(light.w, 0.0) / (kPi));  // radius of a disc of that solid angle
    vec4 core = vec4(0.0), range = vec4(0.0);
    for (uint k = lane; k < count; k += kMeanShiftGroup) {
        const Emitter e = emitters[k];
        if (distance(e.bearing_range.xyz, bearing) > kCore * edge) continue;
        core += vec4(e.radiance_angle.rgb, 1.0) * e.radiance_angle.w;
        const float range_m = e.bearing_range.w;
        const bool on_surface = has_depth && range_m > 0.0 &&
                                distance(camera_m + range_m * e.bearing_range.xyz, mode.point.xyz) <= mode.reach;
        if (on_surface) range.xy += vec2(range_m, 1.0) * e.radiance_angle.w;
    }
    core = sum_of_group(core);
    range = sum_of_group(range);
    if (lane != 0u) return;

    // Pixels of the rim shine in part: what counts is how much of the middle's radiance they add up to.
    const float core_luminance = luminance(core.rgb) / max(core.w, 1e-30);
    const float angle_sr = luminance(light.rgb) / max(core_luminance, 1e-30);
    const float sine = sine_of_cone(angle_sr);
    const float distance_m = range.y > 0.0 ? range.x / range.y / max(1.0 - kCoreBulge * sine, 0.1) : 0.0;
    const float radius_m = distance_m * sine;
    // Radiance times the disc that the sphere shows from afar: pi R^2. (paper, Section 3.2; I = L A)
    const vec3 radiance = light.rgb / max(angle_sr, 1e-30);
    const vec3 intensity = has_depth ? radiance * (kPi * radius_m * radius_m) : light.rgb;
    const bool measured = mode.weight > 0.0 && core.w > 0.0 && (range.y > 0.0 || !has_depth) && !is_covered(candidate);
    const bool whole = (flags_of_group & kEmitterAtBorder) == 0u;
    sightings[candidate] = LightSighting(vec4(camera_m + distance_m * bearing, radius_m), vec4(intensity, 0.0),
                                         vec4(bearing, angle_sr), vec4(camera_m, 0.0), mode.has_depth,
                                         measured && whole ? 1u : 0u, flags_of_group & kEmitterClipped, 0u);
}
