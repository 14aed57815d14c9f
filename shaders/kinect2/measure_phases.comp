// From the codes of a Kinect v2 to a phasor per modulation frequency, and the infrared image. An invocation takes four
// codes that are sent one after the other: software devices are slower with each word that is loaded.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "shared/kinect2/infrared.h"

layout(local_size_x = 128) in;                               // divides the picture
layout(binding = 0, r32ui) uniform readonly uimage2D codes;  // the sub-images' rows one below the other
layout(binding = 1, rgba32f) uniform readonly image2D offsets_ab;
layout(binding = 2, rgba32f) uniform readonly image2D offsets_c_ray;
layout(binding = 3, rgba32f) uniform writeonly image2D phasors_ab;
layout(binding = 4, rgba32f) uniform writeonly image2D phasors_c;  // z: infrared light

const uint kSaturated = 1024u;
const float kHalfSqrt3 = 0.8660254038;
const vec3 kGain = vec3(1.322581, 1.0, 1.612903);  // of 80, 16 and 120 MHz
const float kInfraredGain = kAmplitudeScale * 16.0;

uint word_at(int x, int y) { return imageLoad(codes, ivec2(min(x, int(kRowWords) - 1), y)).x; }

// Four codes of 11 bits, from a bit of a row on.
uvec4 four_codes(uint bit, int row) {
    const int word = int(bit >> 5u);
    const uint shift = bit & 31u;
    const uint middle = word_at(word + 1, row);
    // Shifted left in two steps, since a shift by 32 has no meaning.
    const uint low = word_at(word, row) >> shift | middle << 1u << (31u - shift);
    const uint high = middle >> shift | word_at(word + 2, row) << 1u << (31u - shift);
    return uvec4(low, low >> 11u, low >> 22u | high << 10u, high >> 1u) & 2047u;
}

// Eight octaves of 128 codes, of which each but the first doubles the step; bit 10 is the sign.
vec4 measurements(uvec4 code) {
    const uvec4 octave = code >> 7u & 7u;
    const uvec4 coarse = (code & 127u | 128u) << (max(octave, uvec4(1u)) - 1u);
    const vec4 magnitude = vec4(mix(coarse, code & 127u, equal(octave, uvec4(0u))));
    return mix(magnitude, -magnitude, greaterThanEqual(code, uvec4(1024u)));
}

// Of one frequency at four pixels, from phases of 0, 120 and 240 degrees: the sums of the measurements times the
// phases' cosines and sines.
struct Sums {
    vec4 along, across;
    bvec4 saturated;
};

Sums sums_of(uint bit, int row, int frequency) {
    uvec4 code[3];
    [[unroll]] for (int k = 0; k < 3; ++k) code[k] = four_codes(bit, row + (3 * frequency + k) * int(kInfraredHeight));
    const vec4 second = measurements(code[1]), third = measurements(code[2]);
    Sums sums;
    sums.along = measurements(code[0]) - 0.5 * (second + third);
    sums.across = kHalfSqrt3 * (second - third);
    [[unroll]] for (int i = 0; i < 4; ++i) sums.saturated[i] =
        any(equal(uvec3(code[0][i], code[1][i], code[2][i]), uvec3(kSaturated)));
    return sums;
}

// Turned back by the pixel's own phase offset.
vec2 phasor(Sums sums, int i, vec2 offset, float gain) {
    const float along = sums.along[i], across = sums.across[i];
    return gain * vec2(offset.x * along - offset.y * across, -offset.y * along - offset.x * across);
}

void store_pixel(ivec2 pixel, Sums sums[3], int i) {
    const vec4 ab = imageLoad(offsets_ab, pixel);
    const vec4 c_ray = imageLoad(offsets_c_ray, pixel);
    const vec2 offsets[3] = {ab.xy, ab.zw, c_ray.xy};
    const bool seen = pixel.x > 0 && pixel.x < int(kInfraredWidth) - 1 && c_ray.w > 0.0;
    vec2 phasors[3];
    float sum = 0.0;
    [[unroll]] for (int f = 0; f < 3; ++f) {
        const vec2 measured = phasor(sums[f], i, offsets[f], kGain[f]);
        sum += sums[f].saturated[i] ? kMaxInfrared : length(measured);
        phasors[f] = seen && !sums[f].saturated[i] ? measured : vec2(0.0);
    }
    imageStore(phasors_ab, pixel, vec4(phasors[0], phasors[1]));
    const float infrared = seen ? min(sum / 3.0 * kInfraredGain, kMaxInfrared) : 0.0;
    imageStore(phasors_c, pixel, vec4(phasors[2], infrared, 0.0));
}

void main() {
    const uint first = 4u * gl_GlobalInvocationID.x;  // of the row's codes as they are sent
    const uint sent_row = gl_GlobalInvocationID.y;
    Sums sums[3];
    [[unroll]] for (int f = 0; f < 3; ++f) sums[f] = sums_of(11u * first, int(sent_row), f);
    // A row sends every fourth pixel first; the rows of the lower half come bottom up.
    const uint half_height = kInfraredHeight / 2u;
    const uint y = sent_row < half_height ? sent_row : 3u * half_height - 1u - sent_row;
    const uint x = (first & 127u) * 4u + (first >> 7u);
    [[unroll]] for (int i = 0; i < 4; ++i) store_pixel(ivec2(x + 4u * uint(i), y), sums, i);
}
