// Seeds of one lamp end in one place: keeps the heaviest mode of each neighbourhood, heaviest first. What shines before
// or behind a heavier mode is that one's rim, whose depth readings mix with what is behind, or a lamp partly hidden.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/camera/camera.glsl"
#include "lib/math/cone.glsl"
#include "shared/lighting/find_lights.h"

layout(local_size_x = 1) in;
layout(std140, binding = 0) uniform Params { FindLightsParams params; };
layout(std430, binding = 1) readonly buffer Modes { EmitterMode modes[]; };
layout(std430, binding = 2) writeonly buffer Candidates { EmitterMode candidates[]; };  // weight 0 ends it

shared EmitterMode chosen[kMaxLightCandidates];

bool near(EmitterMode a, EmitterMode b) {
    return a.has_depth == b.has_depth && distance(a.point.xyz, b.point.xyz) <= a.reach;
}

vec3 bearing_of(EmitterMode mode) {
    return mode.has_depth != 0u ? normalize(mode.point.xyz - camera_center_m(params.camera)) : mode.point.xyz;
}

// Whether the discs as which two modes appear touch, to a pixel.
bool overlap(EmitterMode a, EmitterMode b) {
    const float pixel = 1.0 / params.camera.focal_center_px.x;
    const float reach = sine_of_cone(a.angle_sr) + sine_of_cone(b.angle_sr) + pixel;
    return distance(bearing_of(a), bearing_of(b)) <= reach;
}

bool is_new(EmitterMode mode, uint count) {
    for (uint k = 0u; k < count; ++k) {
        if (near(mode, chosen[k]) || overlap(mode, chosen[k])) return false;
    }
    return true;
}

void main() {
    uint count = 0u;
    while (count < kMaxLightCandidates) {
        EmitterMode best = EmitterMode(vec4(0.0), 0.0, 0u, 0.0, 0.0);
        for (uint i = 0u; i < kMeanShiftSeeds; ++i) {
            const EmitterMode mode = modes[i];
            if (mode.weight > best.weight && is_new(mode, count)) best = mode;
        }
        if (best.weight == 0.0) break;
        chosen[count++] = best;
    }
    for (uint k = 0u; k < kMaxLightCandidates; ++k) {
        candidates[k] = k < count ? chosen[k] : EmitterMode(vec4(0.0), 0.0, 0u, 0.0, 0.0);
    }
}
