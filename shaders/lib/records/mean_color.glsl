// A record's colour without most of its highlights: the mean of the darker of its first observations. The includer
// declares the color words, or says how to load them (lib/records/record_colors.glsl).
#ifndef PATINA_LIB_MEAN_COLOR_GLSL
#define PATINA_LIB_MEAN_COLOR_GLSL
#include "lib/records/observations.glsl"
#include "lib/records/record_colors.glsl"

const uint kMeanQuads = 4u;  // of four observations; more of them would tell hardly more

float sum_of(vec3 rgb) { return rgb.r + rgb.g + rgb.b; }

// The mean of those whose channels' sum is at most this, and their number.
vec4 mean_no_brighter(uint chunk_shift, uint id, uint count, float most) {
    vec4 sum = vec4(0.0);
    for (uint quad = 0u; 4u * quad < min(count, 4u * kMeanQuads); ++quad) {
        const uvec4 words = load_colors(chunk_shift, id, quad);
        for (uint i = 0u; i < 4u; ++i) {
            const vec3 rgb = unpack_shared_exponent(words[i]);
            const bool counts = 4u * quad + i < count && sum_of(rgb) <= most;
            sum += counts ? vec4(rgb, 1.0) : vec4(0.0);
        }
    }
    return vec4(sum.rgb / max(sum.w, 1.0), sum.w);
}

// 0 of a record without observations.
vec3 mean_color(uint chunk_shift, uint id, uint count) {
    const vec3 all = mean_no_brighter(chunk_shift, id, count, 1e30).rgb;
    return mean_no_brighter(chunk_shift, id, count, sum_of(all) * 1.0001).rgb;
}

#endif
