// Keyframes by which a lost camera is found again. See passes/tracking/encode_frame.h and
// passes/state/keyframe_store.h.
#ifndef PATINA_SHARED_KEYFRAMES_H
#define PATINA_SHARED_KEYFRAMES_H
#include "shared/interop.h"
INTEROP_BEGIN

INTEROP_CONST uint kSmallWidth = 40u;  // of the picture that ferns look at, in pixels
INTEROP_CONST uint kSmallHeight = 30u;

INTEROP_CONST uint kFerns = 512u;
// A fern's code: four tests, true where the picture's value is above the fern's threshold, and what they are worth.
// Four codes make a word of a frame's, fern 4 i + j in the bits from 8 j on of word i.
INTEROP_CONST uint kFernRed = 1u;
INTEROP_CONST uint kFernGreen = 2u;
INTEROP_CONST uint kFernBlue = 4u;
INTEROP_CONST uint kFernDepth = 8u;
INTEROP_CONST uint kFernHasColor = 16u;  // else the three tests of colour are false and mean nothing
INTEROP_CONST uint kFernHasDepth = 32u;  // likewise
INTEROP_CONST uint kFernWords = 128u;    // kFerns / 4

INTEROP_CONST uint kShrinkFrameGroup = 8u;  // invocations per side
INTEROP_CONST uint kFernGroup = 64u;
INTEROP_CONST uint kRankGroup = 128u;

INTEROP_CONST uint kMostMatches = 32u;
INTEROP_CONST uint kNoKeyframe = 0xffffffffu;

// One fern: a pixel of the small picture, and a threshold for each of its values.
struct Fern {
    uvec2 pixel;
    float depth_m;
    uint pad0;
    vec4 color;  // rgb, square roots of linear values; w unused
};

// A frame that may become a keyframe.
struct KeyframeCandidate {
    mat4 world_from_camera;  // of the depth camera
    uint frame;
    uint well_tracked;  // 0: its pose is not to be relied on
    uint pad0;
    uint pad1;
};

struct Keyframe {
    mat4 world_from_camera;
    uint frame;
    uint pad0;
    uint pad1;
    uint pad2;
};

struct KeyframeCounters {
    uint used;     // keyframes in the store
    uint refused;  // frames that would have become keyframes when it was full
};

// A stored keyframe that looks like the current frame.
struct KeyframeMatch {
    mat4 world_from_camera;
    float dissimilarity;  // 0 to 1: the share of ferns whose codes differ
    uint slot;            // in the store; kNoKeyframe: there is none, and the rest is 0
    uint frame;
    uint pad0;
};

struct ShrinkFrameParams {
    uvec2 depth_extent;  // pixels
    uvec2 color_extent;
};

struct SmoothFrameParams {
    float exponent_per_px2;  // a weight is exp2(exponent_per_px2 * squared distance)
    int radius_px;
};

struct CompareKeyframesParams {
    uint tests;        // which of kFernRed to kFernDepth count
    uint least_ferns;  // with fewer whose depth both frames know, nothing can be said: the dissimilarity is 1
};

struct RankKeyframesParams {
    uint capacity;
    uint matches;
};

struct KeepKeyframeParams {
    uint capacity;
    float least_dissimilarity;  // to every keyframe so far
    uint least_ferns;           // that know the depth
    float near_m;               // a keyframe is near if it is less than this away,
    float near_cosine;          // and turned by less than the angle of this cosine
};

INTEROP_END
#endif
