// Geometric edges between the smooth parts of a frame's surface.
#ifndef PATINA_SHARED_FIND_EDGES_H
#define PATINA_SHARED_FIND_EDGES_H
#include "shared/interop.h"
INTEROP_BEGIN

// What the passes on a frame's surface share. Pixels are those that are looked at.
struct FrameSurfaceParams {
    vec4 focal_center_px;  // fx, fy, cx, cy
    uvec2 extent;          // pixels
    float jump_m;          // readings k pixels apart lie on one surface where their depths differ by at most
    float jump_slope;      // jump_m + k * jump_slope * depth
    float noise_floor_m;   // sigma(z) = noise_floor_m + noise_per_m * z^2
    float noise_per_m;     // 1 / m
    float reach_px_m;      // normals come from, and are compared at, this over z pixels, rounded,
    float min_reach_px;    // at least this
    float max_reach_px;    // and at most that
    float crease_rad;      // a concave crease is an edge where it turns the normal by more than this and
    float crease_sigmas;   // so many sigmas of the angle between two normals
    float step_m;          // and so is a step between parallel surfaces of more than
    float step_sigmas;     // step_m + step_sigmas * sigma(z)
    float cut_chroma;      // and a change of chromaticity by more than
    float cut_light;       // cut_chroma + cut_light / sum of the channels
    float claim_m;         // a pixel joins a segment where it lies off the tangent plane there by at most
    float claim_sigmas;    // claim_m + claim_sigmas * sigma(z)
    int claim_reach_px;    // and so near in x or y
    uint min_pixels;       // smaller components are none
    int color_reach_px;    // how far on both sides of a pixel colours are compared
};

INTEROP_END
#endif
