// Random numbers without state: each is a hash of what it is for. Functions without bindings.
//
// Numbers of one stream (a pixel in a frame) are told apart by `index` (the sample) and `dimension` (what the sample
// uses the number for), which may be any words.
#ifndef PATINA_LIB_RANDOM_GLSL
#define PATINA_LIB_RANDOM_GLSL

// The fractions 1/g and 1/g^2, g^3 = g + 1, times 2^32: steps of the R2 sequence (Roberts, The Unreasonable
// Effectiveness of Quasirandom Sequences, 2018).
const uvec2 kR2Steps = uvec2(3242174889u, 2447445414u);
// In place of a sample's index: the shift of a pixel's whole sequence.
const uint kEverySample = 0xffffffffu;

// Four words that depend on all four of `v` (pcg4d; Jarzynski and Olano, Hash Functions for GPU Rendering, 2020).
uvec4 hash_words(uvec4 v) {
    v = v * 1664525u + 1013904223u;
    for (int round = 0; round < 2; ++round) {
        v.x += v.y * v.w;
        v.y += v.z * v.x;
        v.z += v.x * v.y;
        v.w += v.y * v.z;
        if (round == 0) v ^= v >> 16u;
    }
    return v;
}

// Words as numbers in [0, 1), multiples of 2^-24: exact in fp32, and never rounded up to 1.
vec4 unit_interval(uvec4 words) { return vec4(words >> 8u) * (1.0 / 16777216.0); }

uvec2 random_stream(uvec2 seed, uint frame, uint pixel) { return hash_words(uvec4(seed, frame, pixel)).xy; }

// Four independent, uniform words; unit_interval() makes numbers of them.
uvec4 random_words(uvec2 stream, uint index, uint dimension) { return hash_words(uvec4(stream, index, dimension)); }

// Four independent numbers, uniform in [0, 1).
vec4 random_numbers(uvec2 stream, uint index, uint dimension) {
    return unit_interval(random_words(stream, index, dimension));
}

// Words as those of random_words(), but xy are point `index` of a sequence that fills the unit square evenly, shifted
// at random for each stream and dimension (Cranley and Patterson, 1976). Each point alone is uniform. Points of two
// dimensions of one stream move together: what depends on both needs random_words() for one of them.
uvec4 stratified_words(uvec2 stream, uint index, uint dimension) {
    const uvec2 shift = random_words(stream, kEverySample, dimension).xy;
    return uvec4(shift + index * kR2Steps, random_words(stream, index, dimension).zw);
}

#endif
