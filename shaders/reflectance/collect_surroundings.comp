#version 460
#extension GL_GOOGLE_include_directive : require
// Adds the colours of some pixels to the cells of the surfaces that they show. A pixel without depth shows an opening
// in the plane of its rim: the inverse of a plane's depth is linear over the picture.
#include "lib/camera/camera.glsl"
#include "lib/color/luminance.glsl"
#include "lib/lighting/surroundings.glsl"
#include "lib/map/occupancy.glsl"
#include "lib/math/octahedral.glsl"
#include "shared/reflectance/far_field.h"

layout(local_size_x = kSurroundingsGroup, local_size_y = kSurroundingsGroup) in;
layout(constant_id = 0) const uint kLowExposure = 0u;  // 1: of a frame of low exposure
layout(binding = 0, r32f) uniform readonly image2D depth_m;
layout(binding = 1, rgba16f) uniform readonly image2D color_linear;
layout(std140, binding = 2) uniform Params { SurroundingsParams params; };
layout(std430, binding = 3) buffer Surroundings{SURROUNDINGS_MEMBERS};

const int kSearchStepPx = 3;
const uint kMostSearchSteps = 192u;
const float kLeastOpeningPx = 16.0;  // narrower gaps are shadows of the depth camera, or noise

// How far the next reading is along a row or a column, pixels, and its inverse depth; 0 where there is none.
vec2 find_rim(ivec2 pixel, ivec2 way, ivec2 extent) {
    vec2 found = vec2(0.0);
    ivec2 at = pixel;
    for (uint i = 1u; i <= kMostSearchSteps && found.y == 0.0; ++i) {
        at += kSearchStepPx * way;
        if (any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, extent))) break;
        const float reading = imageLoad(depth_m, at).x;
        found = reading > 0.0 ? vec2(float(i) * float(kSearchStepPx), 1.0 / reading) : vec2(0.0);
    }
    return found;
}

// The weighted inverse depth between two rims that face each other, and the weight; 0 without both.
vec2 between_rims(vec2 a, vec2 b) {
    const float gap = a.x + b.x;
    if (a.x == 0.0 || b.x == 0.0 || gap < kLeastOpeningPx) return vec2(0.0);
    return vec2((a.y * b.x + b.y * a.x) / gap, 1.0) / gap;
}

float depth_of_opening(ivec2 pixel, ivec2 extent) {
    const vec2 along = between_rims(find_rim(pixel, ivec2(-1, 0), extent), find_rim(pixel, ivec2(1, 0), extent));
    const vec2 across = between_rims(find_rim(pixel, ivec2(0, -1), extent), find_rim(pixel, ivec2(0, 1), extent));
    const vec2 sum = along + across;
    return sum.y > 0.0 ? sum.y / sum.x : 0.0;
}

// Whether a key is in a place of the table, which it takes where that is free and `grows`.
bool is_placed(uint place, uint key, ivec3 cell, bool grows) {
    if (!grows) return surroundings[place].key == key;
    const uint found = atomicCompSwap(surroundings[place].key, 0u, key);
    if (found == key) return true;
    if (found != 0u) return false;
    MARK_CELL(cells_in_use, cell)
    atomicAdd(surroundings_counts.fresh, 1u);
    return true;
}

#define ADD_TO(sums, steps)      \
    atomicAdd(sums.samples, 1u); \
    atomicAdd(sums.r, steps.r);  \
    atomicAdd(sums.g, steps.g);  \
    atomicAdd(sums.b, steps.b);

void add_to_opening(vec3 direction, uvec3 steps) {
    const uint texel = octahedral_texel(direction, kOpeningEdge);
    if (kLowExposure != 0u) {
        ADD_TO(openings[texel].light.low, steps)
    } else {
        ADD_TO(openings[texel].light.usual, steps)
    }
}

void add_to_cell(ivec3 cell, bool opening, uvec3 steps) {
    const uint key = surroundings_key(cell);
    const bool grows = surroundings_counts.total < kMostSurroundings;
    for (uint probe = 0u; probe < kSurroundingsProbes; ++probe) {
        const uint place = surroundings_place(key, probe);
        if (!is_placed(place, key, cell, grows)) continue;
        if (opening) atomicAdd(surroundings[place].openings, 1u);
        if (kLowExposure != 0u) {
            ADD_TO(surroundings[place].light.low, steps)
        } else {
            ADD_TO(surroundings[place].light.usual, steps)
        }
        return;
    }
}

void main() {
    if (any(greaterThanEqual(gl_GlobalInvocationID.xy, params.visited))) return;
    const uvec2 offset = uvec2(params.phase % params.stride_px, params.phase / params.stride_px);
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy * params.stride_px + offset), extent = imageSize(depth_m);
    if (any(greaterThanEqual(pixel, extent))) return;
    const float reading = imageLoad(depth_m, pixel).x;
    const float depth = reading > 0.0 ? reading : depth_of_opening(pixel, extent);
    if (depth == 0.0) return;
    const vec3 in_depth_m = unproject(params.depth_camera, vec2(pixel)) * depth;
    const vec3 direction = to_world_direction(params.depth_camera, in_depth_m);
    const vec3 point_m = camera_center_m(params.depth_camera) + direction;
    const vec3 in_color_m = to_camera(params.color_camera, point_m);
    if (in_color_m.z < kNearestDepth) return;
    const ivec2 seen_by = ivec2(floor(project(params.color_camera, in_color_m) + 0.5));
    if (any(lessThan(seen_by, ivec2(0))) || any(greaterThanEqual(seen_by, ivec2(params.color_camera.extent)))) return;
    const vec4 color = imageLoad(color_linear, seen_by);
    const bool lamp = kLowExposure != 0u && luminance(color.rgb) >= params.lamp_luminance;
    if (color.a == 0.0 || lamp) return;
    const vec3 rgb = (kLowExposure != 0u ? params.radiance_scale : 1.0) * color.rgb;
    const uvec3 steps = uvec3(clamp(rgb, 0.0, kSurroundingsRange) * kSurroundingsSteps + 0.5);
    add_to_cell(surroundings_cell(point_m), reading == 0.0, steps);
    if (reading == 0.0) add_to_opening(direction, steps);
}
