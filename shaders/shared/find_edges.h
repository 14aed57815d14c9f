// Geometric edges between the smooth parts of a frame's surface.
#ifndef PATINA_SHARED_FIND_EDGES_H
#define PATINA_SHARED_FIND_EDGES_H
#include "shared/camera.h"
INTEROP_BEGIN

struct ChooseSurfaceParams {
    Camera camera;
    float noise_floor_m;      // sigma(z) = noise_floor_m + noise_per_m * z^2
    float noise_per_m;        // 1 / m
    float agreement_floor_m;  // a reading belongs to the model where its distance from the model's tangent plane is at
    float agreement_sigmas;   // most agreement_floor_m + agreement_sigmas * sigma(z)
};

struct FindEdgesParams {
    vec4 focal_center_px;  // fx, fy, cx, cy
    uvec2 extent;          // pixels
    float noise_floor_m;   // sigma(z) = noise_floor_m + noise_per_m * z^2
    float noise_per_m;     // 1 / m
    float reach_px_m;      // neighbours are compared at this over z pixels, rounded,
    float min_reach_px;    // at least this
    float max_reach_px;    // and at most that
    float step_floor_m;    // a step is an edge from step_floor_m + step_sigmas * sigma(z) on
    float step_sigmas;
    float crease_cosine;  // a concave crease is an edge where the normals' cosine is below this
    uint pad0;
    uint pad1;
};

INTEROP_END
#endif
