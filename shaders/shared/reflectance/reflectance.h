// Visibility of lights and refinement of the albedo, by record of the observation map.
#ifndef PATINA_SHARED_REFLECTANCE_H
#define PATINA_SHARED_REFLECTANCE_H
#include "shared/lighting/lights.h"
#include "shared/observation/observations.h"
INTEROP_BEGIN

INTEROP_CONST float kKdDeviation = 0.05f;    // an albedo of this standard deviation has half the weight of an exact one
INTEROP_CONST uint kWindowGroup = 64u;       // of the pass over table slots
INTEROP_CONST float kBusyChanges = 1024.0f;  // so many changed records, and all of a window are marched again;
INTEROP_CONST float kLeastRefreshed = 1.0f / 16.0f;  // of fewer their share, but no less than this

// The specular part of a segment's material; label 0, and labels without an entry, have none.
struct SegmentMaterial {
    vec4 ks_alpha;     // rgb, Ward roughness
    uint version;      // changes with the material, above 0; 0: no entry
    float mirror;      // 1: a metal or a mirror, which has no diffuse part; passes/specular/fit_mirrors.h
    float unobserved;  // the share of ks that is a guess, which refinement leaves out
    uint pad0;
};

// A segment's albedo: sums over its records, whole numbers, so that the order of arrival does not matter.
struct SegmentAlbedo {
    uvec4 kd;      // rgb: certainty times kd (up to 1), in steps of 1 / (kCertaintySteps kAlbedoSteps); w: all records
    uvec4 weight;  // rgb: certainty, in steps of 1 / kCertaintySteps; w: observations
};
INTEROP_CONST float kAlbedoSteps = 1023.0f;  // 32 bits hold the sums of 1.3 M records
INTEROP_CONST float kCertaintySteps = 3.0f;
INTEROP_CONST float kTextureDeviation = 0.1f;    // of a record's albedo from its segment's mean
INTEROP_CONST float kMostRawKd = 4.0f;           // of a stored albedo: above 1 the light is taken for too weak
INTEROP_CONST float kSurfaceDeviation = 0.015f;  // and from that of the surface around that looks the same
INTEROP_CONST float kLeastSegmentWeight = 3.0f;  // records, certain ones, that a segment's albedo takes

// What a record's visibility and albedo were computed from.
struct RecordStatus {
    uint marched;       // surface and version of the lights' positions, lib/records/reflectance.glsl; 0: never
    uint refined;       // versions of lights and material; 0: never
    uint march_stamp;   // the update that listed it last for marching
    uint refine_stamp;  // for refinement
    uvec2 uncertain;    // a bit per light that may or may not reach the voxel, or does so in part
    uvec2 incident;     // light from what is around: lib/records/gathered_light.glsl; 0: none was gathered
    uint bright;        // radiance at low exposure, where the usual one may be clipped: shared exponent; 0: not known
    uint pad0;
};

// What a record gathered and heard from those around.
struct RecordSurroundings {
    uvec2 rays;   // its own: lib/records/gathered_light.glsl
    uint around;  // albedo of the surface around (passes/reflectance/surface_albedo.h), shared exponent; 0: not known
    uint pad0;
};

// Which records had their turn in one update: those of blocks whose keys' hashes lie in a window of kWindowSteps steps.
// How large the table is does not matter, nor what else it holds.
struct RefreshWindow {
    uint first;    // step
    uint steps;    // 0: there was no such update
    uint records;  // that it looked at
    uint pad0;
};
INTEROP_CONST uint kWindowSteps = 32768u;  // a power of two
INTEROP_CONST uint kWindows = 3u;          // of this update, of the one before, and of the next, which counts from 0

struct ReflectanceParams {
    VoxelGrid records;  // the observation map's grid
    VoxelGrid voxels;   // the voxel map's
    uint edge_shift;    // of the observation map
    uint stamp;         // the update's index + 1
    uint refreshed;     // records looked at again in one update though nothing says that they have changed, about
    uint max_steps;     // of a window
    uint shadows;       // 0: every light reaches every voxel
    uint materials;     // entries of the table
    float least_share;  // of the records looked at, that is marched again although no record changed
    uint all;           // 1: the window is as large as it may be
    vec4 ball_m;        // centre in the world, radius: what lies outside throws no shadow
    vec4 cube_m;        // centre in the world, half edge: of records outside none has its turn
};

// Which of the records that wait for marching are taken.
struct AcceptParams {
    uint stamp;  // as ReflectanceParams
    uint most;   // about
};

INTEROP_END
#endif
