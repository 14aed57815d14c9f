// Lamps found in frames of low exposure (paper, Section 3.2): pixels that shine, clusters of them, lights seen in many
// frames.
#ifndef PATINA_SHARED_FIND_LIGHTS_H
#define PATINA_SHARED_FIND_LIGHTS_H
#include "shared/input/camera.h"
#include "shared/lighting/lights.h"
INTEROP_BEGIN

INTEROP_CONST uint kEmitterGroup = 256u;       // consecutive pixels that one group looks at
INTEROP_CONST uint kMaxEmitters = 65536u;      // pixels of one frame that are taken, in the picture's order
INTEROP_CONST uint kMeanShiftSeeds = 256u;     // evenly spread over the list of emitters
INTEROP_CONST uint kMeanShiftGroup = 64u;      // invocations per seed
INTEROP_CONST uint kMaxLightCandidates = 32u;  // of one frame
INTEROP_CONST uint kMaxLights = 64u;
INTEROP_CONST uint kMaxSightings = 128u;  // the last ones of a light that are kept
INTEROP_CONST uint kNoDepth = 0xffffffffu;

// What an emitter's pixel is like.
INTEROP_CONST uint kEmitterClipped = 1u;   // a channel is clipped: the radiance is a lower bound
INTEROP_CONST uint kEmitterAtBorder = 2u;  // at the picture's border: part of the lamp may be outside

// What all passes of a frame need; a uniform buffer.
struct FindLightsParams {
    Camera camera;          // colour camera
    float threshold;        // luminance of a pixel value above which a pixel shines
    float radiance_scale;   // from pixel values to those of the reflectance sequence
    float bandwidth_m;      // least radius of the mean-shift kernel for emitters with depth
    float bandwidth_chord;  // and for those without: on the unit sphere of bearings
    float match_m;          // within which a candidate is a light seen before
    float match_rad;        // likewise, for bearings
    uint group_count;       // of kEmitterGroup pixels
    uint pad0;
};

struct WarpDepthParams {
    Camera depth_camera;
    float units_per_m;  // of the warped depth
    uint reach_px;      // a depth pixel covers this many colour pixels to each side
    uint pad0;
    uint pad1;
};

// A pixel that shines.
struct Emitter {
    vec4 bearing_range;  // xyz: unit direction from the camera, world; w: distance to the surface in m, 0 without depth
    vec4 radiance_angle;  // rgb: linear pixel values of the reflectance sequence; w: solid angle, sr
    uint flags;
    uint pad0;
    uint pad1;
    uint pad2;
};

// Where a mean-shift ended.
struct EmitterMode {
    vec4 point;      // xyz: world m with depth, unit bearing without; w unused
    float weight;    // luminous mass within the kernel; 0: no mode
    uint has_depth;  // 1 or 0
    float angle_sr;  // solid angle of the emitters within the kernel
    float reach;     // radius of the kernel: m with depth, on the unit sphere without
};

// A lamp as one frame shows it.
struct LightSighting {
    vec4 center_radius;  // xyz: world, m; w: radius of the sphere it appears as, m; 0 without depth
    vec4 intensity;      // rgb: W/sr of pixel values with depth; sum of radiance times solid angle without; w unused
    vec4 bearing;        // xyz: unit direction from the camera; w: solid angle, sr
    vec4 camera_m;       // xyz: the camera's centre; w unused
    uint has_depth;      // 1 or 0
    uint valid;          // 0: cut off by the picture's border, or too faint to be measured
    uint clipped;        // 1 when a pixel is clipped
    uint pad0;
};

// A lamp over all frames so far; its sightings stand in an array of their own.
struct LightTrack {
    vec4 place;      // xyz: mean centre with depth, last bearing without; w unused
    uint sightings;  // so far; the last kMaxSightings are kept
    uint has_depth;  // 1 or 0
    uint clipped;    // sightings with clipped pixels
    uint pad0;
};

// The answer.
struct FoundLight {
    PointLight light;
    float spread_m;  // median distance of the sightings from the position
    uint sightings;
    uint has_depth;  // 0: triangulated from bearings
    uint clipped;    // sightings with clipped pixels
};

INTEROP_END
#endif
