// Joins a frame's sightings to the lights seen before.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/lighting/find_lights.h"

layout(local_size_x = 1) in;
layout(std140, binding = 0) uniform Params { FindLightsParams params; };
layout(std430, binding = 1) readonly buffer Sightings { LightSighting sightings[]; };  // of this frame
layout(std430, binding = 2) buffer Tracks { LightTrack tracks[]; };                    // sightings 0 ends the list
layout(std430, binding = 3) buffer History { LightSighting history[]; };  // kMaxSightings per light, a ring

const uint kNone = 0xffffffffu;

// How far a sighting is from a light, in units within which they are one.
float mismatch(LightSighting s, LightTrack t) {
    if (s.has_depth != t.has_depth) return 1e30;
    if (s.has_depth != 0u) return distance(s.center_radius.xyz, t.place.xyz) / params.match_m;
    return distance(s.bearing.xyz, t.place.xyz) / params.match_rad;
}

// A lamp whose depth is missing in this frame only: it stands where one with depth was found.
bool is_known(LightSighting s) {
    if (s.has_depth != 0u) return false;
    for (uint i = 0u; i < kMaxLights && tracks[i].sightings > 0u; ++i) {
        const vec3 toward = normalize(tracks[i].place.xyz - s.camera_m.xyz);
        if (tracks[i].has_depth != 0u && distance(toward, s.bearing.xyz) <= params.match_rad) return true;
    }
    return false;
}

void join(LightSighting s) {
    uint best = kNone;
    float least = 1.0;
    uint count = 0u;
    for (; count < kMaxLights && tracks[count].sightings > 0u; ++count) {
        const float m = mismatch(s, tracks[count]);
        if (m < least) {
            least = m;
            best = count;
        }
    }
    if (best == kNone) {
        if (count == kMaxLights) return;
        best = count;
        tracks[best] = LightTrack(vec4(0.0), 0u, s.has_depth, 0u, 0u);
    }
    const uint seen = tracks[best].sightings;
    const float share = s.has_depth != 0u ? 1.0 / float(seen + 1u) : 1.0;
    const vec3 place = s.has_depth != 0u ? s.center_radius.xyz : s.bearing.xyz;
    tracks[best].place.xyz += share * (place - tracks[best].place.xyz);
    tracks[best].sightings = seen + 1u;
    tracks[best].clipped += s.clipped;
    history[best * kMaxSightings + seen % kMaxSightings] = s;
}

void main() {
    for (uint k = 0u; k < kMaxLightCandidates; ++k) {
        const LightSighting s = sightings[k];
        if (s.valid != 0u && !is_known(s)) join(s);
    }
}
