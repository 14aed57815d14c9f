// A Kinect v2's infrared frame as it is transmitted, and what decodes it.
#ifndef PATINA_SHARED_KINECT2_INFRARED_H
#define PATINA_SHARED_KINECT2_INFRARED_H
#include "shared/interop.h"
INTEROP_BEGIN

INTEROP_CONST uint kInfraredWidth = 512u;   // pixels
INTEROP_CONST uint kInfraredHeight = 424u;  // pixels
INTEROP_CONST uint kPhaseImages = 9u;       // three phases of each of three frequencies; ambient light is left out
INTEROP_CONST uint kRowWords = 176u;        // a row of a sub-image: 512 codes of 11 bits in 32-bit words

INTEROP_CONST float kMaxInfrared = 65535.0f;     // of the infrared image; also where a measurement is saturated
INTEROP_CONST float kAmplitudeScale = 2.0f / 3;  // from the length of a phasor to an amplitude

INTEROP_CONST float kEmitterBaseline = 90.0f;    // mm, twice the emitter's distance from the camera along x
INTEROP_CONST float kUnambiguous = 6250.0f / 3;  // mm of depth on the axis at a mean of one cycle
INTEROP_CONST uint kNoSource = 0xffffffffu;      // of an undistorted pixel that the sensor did not see

INTEROP_END
#endif
