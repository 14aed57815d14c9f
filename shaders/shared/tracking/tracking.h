// Tracking the camera against the model: pyramids of the frame and of the model, and the state of one frame's search
// for its pose. See passes/tracking.
#ifndef PATINA_SHARED_TRACKING_H
#define PATINA_SHARED_TRACKING_H
#include "shared/input/camera.h"
INTEROP_BEGIN

INTEROP_CONST uint kTrackGroupX = 32u;  // of the passes that go over pixels
INTEROP_CONST uint kTrackGroupY = 4u;
INTEROP_CONST uint kNormalEquationsGroupY = 2u;     // fewer invocations, each with
INTEROP_CONST uint kNormalEquationsMostRows = 64u;  // up to so many pixels of one column, kNormalEquationsGroupY rows
INTEROP_CONST uint kNormalEquationsUnrolled = 8u;   // apart; a multiple of this
INTEROP_CONST uint kSolveMotionGroup = 40u;         // an invocation for each entry of the matrix and each sum

// What one group of pixels adds to the normal equations, in this order: the upper triangle of the 6 x 6 matrix row by
// row, the right side, then the sums below.
INTEROP_CONST uint kTrackMatrix = 0u;
INTEROP_CONST uint kTrackRight = 21u;
INTEROP_CONST uint kTrackReadings = 27u;      // pixels with a reading
INTEROP_CONST uint kTrackPairs = 28u;         // of these, how many lie on the model, each by its robust weight
INTEROP_CONST uint kTrackSquares = 29u;       // weight times squared distance in sigmas
INTEROP_CONST uint kTrackWeight = 30u;        // 1 / m^2, of the distances
INTEROP_CONST uint kTrackDepth = 31u;         // m, of the readings
INTEROP_CONST uint kTrackShades = 32u;        // pairs whose shades were compared, each by its robust weight
INTEROP_CONST uint kTrackShadeSquares = 33u;  // weight times squared difference
INTEROP_CONST uint kTrackShadeProduct = 34u;  // weight times shade of the frame times that of the model
INTEROP_CONST uint kTrackShadeOwn = 35u;      // weight times squared shade of the frame
INTEROP_CONST uint kTrackSums = 36u;

// A pixel of the frame in 32 bits: 20 bits of depth in units of 2^-16 m, 0 where there is no reading; 12 bits of shade,
// the square root of the luminance, which evens out a camera's noise, in units of 1 / 2047.
INTEROP_CONST float kDepthUnitsPerMetre = 65536.0f;
INTEROP_CONST uint kMostDepthUnits = 0xfffffu;  // 16 m
INTEROP_CONST float kShadeUnits = 2047.0f;
INTEROP_CONST uint kNoShade = 0xfffu;             // not seen, or clipped
INTEROP_CONST float kModelShadeUnits = 16383.0f;  // of a pixel of the model, below 0 where there is none

// The state of the search. The model was cast into a camera "reference"; the frame's camera is sought relative to it.
struct TrackState {
    vec4 rotation;       // reference_from_frame: unit quaternion x, y, z, w
    vec4 translation_m;  // reference_from_frame; w unused
    vec4
        eigenvalues_low;  // of the matrix over kTrackWeight, ascending, the first four: how much of the surface resists
    vec2 eigenvalues_high;  // motion that way
    float held;             // directions in which the last solution did not move
    float gain;             // the frame's shades times this are the model's
    float lever_m;          // rotations count as the way that a point goes so far from the centre of rotation,
    float center_m;         // which lies so far along the reference camera's optical axis
    float readings;         // of the last solution: kTrackReadings
    float pairs;            // kTrackPairs
    float sigmas;           // root mean square of the distances, in sigmas of the sensor
    float shade_error;      // root mean square of the differences of shade; 0 without any
    float shades;           // kTrackShades
    float step_m;           // how far the last solution moved the camera,
    float step_rad;         // and turned it
    float mean_depth_m;     // of the readings
    float solutions;        // so far; 0 where one failed
};

// Frame to packed pixels; a uniform buffer. The colour camera is where it was relative to the depth camera.
struct PackFrameParams {
    vec4 focal_center_px;  // of the depth camera
    Camera color_camera;   // camera_from_world: from the depth camera
    float jump_m;          // a reading whose neighbour is farther away than jump_m + jump_slope * depth lies at an edge
    float jump_slope;
    float max_depth_m;  // farther readings count as none
    uint shaded;        // whether shades are wanted
};

// The model as cast, to packed pixels.
struct PackModelParams {
    Camera camera;
    float jump_m;
    float jump_slope;
    float least_cosine;  // between normal and direction to the camera
    uint shaded;
};

struct HideHighlightsParams {
    uvec2 extent;
    float most_share;  // of a re-rendering's luminance that specular reflection may make up
    uint pad0;
};

struct HalveParams {
    uvec2 extent;  // of the result
    float jump_m;  // readings farther apart than jump_m + jump_slope * depth are not averaged
    float jump_slope;
};

// One iteration on one level.
struct NormalEquationsParams {
    vec4 frame_focal_center_px;
    vec4 model_focal_center_px;
    uvec2 frame_extent;
    uvec2 model_extent;
    float gate_m;  // pairs farther apart than gate_m + gate_slope * depth are none
    float gate_slope;
    float noise_floor_m;  // sigma of a reading: noise_floor_m + noise_per_m * z^2
    float noise_per_m;
    float robust_sigmas;  // a pair so many sigmas apart has a quarter of its weight
    float shade_sigma;    // of a difference of shade; 0: shades are not compared
    float robust_shade;   // a difference so large has a quarter of its weight
    uint rows;            // pixels of an invocation: a multiple of kNormalEquationsUnrolled
};

struct SolveMotionParams {
    uint groups;           // whose sums there are
    float held_share;      // directions whose eigenvalue is below this are held
    float least_readings;  // with fewer pairs nothing is solved
    uint pad0;
};

INTEROP_END
#endif
