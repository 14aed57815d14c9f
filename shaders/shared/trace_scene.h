// Ray-traces a synthetic scene: rectangles, boxes and spheres of Ward materials under point lights.
#ifndef PATINA_SHARED_TRACE_SCENE_H
#define PATINA_SHARED_TRACE_SCENE_H
#include "shared/camera.h"
INTEROP_BEGIN

INTEROP_CONST uint kTraceSceneRays = 4u;  // pixels of one column that an invocation traces

struct TraceObject {
    mat4 object_from_world;  // rigid, metres
    vec4 half_size_m;        // xyz: a box's half edges; xy: those of a rectangle at z = 0; x: a sphere's radius
    vec4 kd;                 // rgb; w unused
    vec4 ks_alpha;           // rgb, roughness
    uint id;                 // what the object id image shows, above 0
    uint pad0;
    uint pad1;
    uint pad2;
};

struct TraceLight {
    vec4 position_m;  // xyz world; w unused
    vec4 intensity;   // rgb, linear pixel value * m^2; w unused
};

struct TraceSceneParams {
    Camera camera;
    uint rectangle_count;  // objects are sorted: rectangles, then boxes, then spheres
    uint box_count;
    uint sphere_count;
    uint light_count;
};

INTEROP_END
#endif
