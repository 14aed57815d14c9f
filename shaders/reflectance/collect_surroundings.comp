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
const float kLeastOpeningPx = 18.0;  // narrower gaps are shadows of the depth camera, or noise
const uint kEdge = kSurroundingsGroup;

// A group's pixels lie in few rows and columns, so that what lies beyond the group is searched once for each of these.
shared float readings[kEdge][kEdge];  // by row; 0 where there is none
shared vec2 rims[2][2][kEdge];        // rows, columns; towards their beginnings, ends: as find_rim()

// The next reading from a pixel on along a row or a column: how far it is, pixels, and its inverse depth; 0 where there
// is none.
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

// What of a group's pixels lies in line with a place, along its row (axis 0) or its column.
float reading_beside(uvec2 place, uint axis, uint at) {
    return axis == 0u ? readings[place.y][at] : readings[at][place.x];
}

// The rim on one side of a place in the group that has no reading.
vec2 rim_beside(uvec2 place, uint axis, uint side) {
    const uint own = place[axis], away = side == 0u ? own : kEdge - 1u - own;
    for (uint i = 1u; i <= away; ++i) {
        const float reading = reading_beside(place, axis, side == 0u ? own - i : own + i);
        if (reading > 0.0) return vec2(float(i * params.stride_px), 1.0 / reading);
    }
    const vec2 beyond = rims[axis][side][place[1u - axis]];
    return beyond.x > 0.0 ? vec2(beyond.x + float(away * params.stride_px), beyond.y) : vec2(0.0);
}

// The weighted inverse depth between two rims that face each other, and the weight; 0 without both.
vec2 between_rims(vec2 a, vec2 b) {
    const float gap = a.x + b.x;
    if (a.x == 0.0 || b.x == 0.0 || gap < kLeastOpeningPx) return vec2(0.0);
    return vec2((a.y * b.x + b.y * a.x) / gap, 1.0) / gap;
}

float depth_of_opening(uvec2 place) {
    const vec2 along = between_rims(rim_beside(place, 0u, 0u), rim_beside(place, 0u, 1u));
    const vec2 across = between_rims(rim_beside(place, 1u, 0u), rim_beside(place, 1u, 1u));
    const vec2 sum = along + across;
    return sum.y > 0.0 ? sum.y / sum.x : 0.0;
}

// The pixel of a place in this group.
ivec2 pixel_of(uvec2 place) {
    const uvec2 offset = uvec2(params.phase % params.stride_px, params.phase / params.stride_px);
    return ivec2((gl_WorkGroupID.xy * kEdge + place) * params.stride_px + offset);
}

// Invocation n < 4 kEdge: the rim beyond the group on one side of a row or a column, if its last pixel there has none.
void find_rims_beyond(uint n, ivec2 extent) {
    if (n >= 4u * kEdge) return;
    const uint line = n % kEdge, side = n / kEdge % 2u, axis = n / kEdge / 2u;
    const uint last = side == 0u ? 0u : kEdge - 1u;
    const uvec2 place = axis == 0u ? uvec2(last, line) : uvec2(line, last);
    const ivec2 way = (side == 0u ? -1 : 1) * ivec2(1u - axis, axis);
    rims[axis][side][line] = readings[place.y][place.x] > 0.0 ? vec2(0.0) : find_rim(pixel_of(place), way, extent);
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
    const uvec2 place = gl_LocalInvocationID.xy;
    const ivec2 pixel = pixel_of(place), extent = imageSize(depth_m);
    const bool inside = all(lessThan(gl_GlobalInvocationID.xy, params.visited)) && all(lessThan(pixel, extent));
    const float reading = inside ? imageLoad(depth_m, pixel).x : 0.0;
    readings[place.y][place.x] = reading;
    barrier();
    find_rims_beyond(gl_LocalInvocationIndex, extent);
    barrier();
    if (!inside) return;
    const float depth = reading > 0.0 ? reading : depth_of_opening(place);
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
