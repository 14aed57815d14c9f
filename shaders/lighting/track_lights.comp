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

void add_to_track(LightSighting s, uint track) {
    const uint seen = tracks[track].sightings;
    const float share = s.has_depth != 0u ? 1.0 / float(seen + 1u) : 1.0;
    const vec3 place = s.has_depth != 0u ? s.center_radius.xyz : s.bearing.xyz;
    tracks[track].place.xyz += share * (place - tracks[track].place.xyz);
    tracks[track].sightings = seen + 1u;
    tracks[track].clipped += s.clipped;
    history[track * kMaxSightings + seen % kMaxSightings] = s;
}

uint open_sightings = 0u;  // of the frame, that belong to no light yet; a bit each
uvec2 joined = uvec2(0u);  // lights that have one already: what a frame shows apart are two lamps, however near

bool is_joined(uint track) { return (joined[track >> 5u] >> (track & 31u) & 1u) != 0u; }

// Joins the sighting and the light that are nearest to each other. False where none are near.
bool join_nearest(uint lights) {
    uint best_sighting = kNone, best_track = kNone;
    float least = 1.0;
    for (uint k = 0u; k < kMaxLightCandidates; ++k) {
        if ((open_sightings >> k & 1u) == 0u) continue;
        for (uint i = 0u; i < lights; ++i) {
            const float m = is_joined(i) ? least : mismatch(sightings[k], tracks[i]);
            if (m >= least) continue;
            least = m;
            best_sighting = k;
            best_track = i;
        }
    }
    if (best_sighting == kNone) return false;
    add_to_track(sightings[best_sighting], best_track);
    open_sightings &= ~(1u << best_sighting);
    joined[best_track >> 5u] |= 1u << (best_track & 31u);
    return true;
}

void main() {
    for (uint k = 0u; k < kMaxLightCandidates; ++k)
        if (sightings[k].valid != 0u && !is_known(sightings[k])) open_sightings |= 1u << k;
    uint lights = 0u;
    while (lights < kMaxLights && tracks[lights].sightings > 0u) ++lights;
    while (join_nearest(lights)) {
    }
    for (uint k = 0u; k < kMaxLightCandidates && lights < kMaxLights; ++k) {
        if ((open_sightings >> k & 1u) == 0u) continue;
        tracks[lights] = LightTrack(vec4(0.0), 0u, sightings[k].has_depth, 0u, 0u);
        add_to_track(sightings[k], lights++);
    }
}
