// A layer of a view as a picture: passes/viewer/draw_layer.h.
#ifndef PATINA_SHARED_DRAW_LAYER_H
#define PATINA_SHARED_DRAW_LAYER_H
#include "shared/interop.h"
INTEROP_BEGIN

INTEROP_CONST uint kDrawLayerGroup = 8u;  // invocations per side

// How a value becomes a colour.
INTEROP_CONST uint kDrawColor = 0u;   // linear rgb, exposed
INTEROP_CONST uint kDrawNormal = 1u;  // a direction: n / 2 + 1/2
INTEROP_CONST uint kDrawScale = 2u;   // one channel, through the scale of colours

struct DrawLayerParams {
    vec4 camera_m;   // xyz world; w: how much darker surfaces are that turn away from the camera, 0 to 1
    uint style;      // kDraw...
    uint channel;    // of a scale, 0 to 3
    float low;       // of a scale: the value that its first colour stands for
    float high;      // and its last one
    float exposure;  // of a colour
    float shoulder;  // of a colour: from this value on, below 1, brighter ones are compressed; 1: they are clipped
    uint pad0;
    uint pad1;
};

INTEROP_END
#endif
