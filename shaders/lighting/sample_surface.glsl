// What a record of the observation map shows as a sample of the surface. The includer declares Records, the chunks of
// Directions and Colors, and the push constants `params`.
#include "lib/math/mean.glsl"
#include "lib/records/record_colors.glsl"
#include "lib/records/record_directions.glsl"
#include "lib/records/reflectance.glsl"
#include "shared/lighting/fit_lights.h"

// The share of the observations, darkest first, whose mean is taken for free of highlights; and the one above which
// highlights are told.
const float kDarkShare = 0.4;
const float kUsualShare = 0.3;

float brightness_of[kMaxObservations];

// How many observations are darker.
uint rank_of(uint item, uint count) {
    const float own = brightness_of[item];
    uint rank = 0u;
    for (uint k = 0u; k < count; ++k) {
        rank += uint(brightness_of[k] < own || (brightness_of[k] == own && k < item));
    }
    return rank;
}

// But for the light around it.
LightSample sample_of(uint record, VoxelRecord known) {
    const uint count = observation_count(known);
    for (uint k = 0u; k < count; ++k) {
        brightness_of[k] = mean_of(unpack_shared_exponent(load_color(params.grid.chunk_shift, record, k)));
    }
    const uint dark = max(uint(kDarkShare * float(count)), 1u);
    const uint usual = uint(kUsualShare * float(count));
    vec3 diffuse = vec3(0.0);
    float usual_brightness = 0.0;
    uint brightest = 0u;
    for (uint k = 0u; k < count; ++k) {
        const uint rank = rank_of(k, count);
        if (rank < dark) diffuse += unpack_shared_exponent(load_color(params.grid.chunk_shift, record, k));
        if (rank == usual) usual_brightness = brightness_of[k];
        if (rank == count - 1u) brightest = k;
    }
    const float excess = brightness_of[brightest] - usual_brightness;
    const bool shines = excess > kHighlightFloor + kHighlightShare * usual_brightness;
    LightSample result;
    result.point_m = vec4(surface_point_m(known, params.grid, params.edge_shift), float(count));
    result.normal = vec4(surface_normal(known), 0.0);
    result.diffuse = vec4(diffuse / float(dark), 0.0);
    result.highlight = vec4(observation_direction(load_direction(params.grid.chunk_shift, record, brightest)),
                            shines ? min(excess, kMostHighlight) : 0.0);
    return result;
}

// A place of the samples by a hash of block and seed, and what decides between the records that want it, unique among
// them: neither depends on record ids.
struct Claim {
    uint place;
    uint priority;  // above 0
};

// Another one for each block.
uint claim_hash(VoxelRecord known) { return hash_of_key(known.block_key ^ params.seed); }

// The bits of the hash choose the place; the others and the voxel, which follows the hash, the priority.
Claim claim_of(VoxelRecord known) {
    const uint hash = claim_hash(known);
    const uint voxel = (voxel_in_block(known) ^ hash >> 16) & 0x3fu;
    return Claim(hash % kLightSamples, 1u + (hash / kLightSamples << 6 | voxel));
}

// Highlights are few: a block's voxels have eight places.
Claim highlight_claim_of(VoxelRecord known) {
    const uint hash = claim_hash(known), voxel = voxel_in_block(known);
    const uint classes = kLightSamples / 8u;
    return Claim(kLightSamples + (hash % classes * 8u | voxel & 7u), 1u + (hash / classes << 6 | voxel));
}

bool is_candidate(VoxelRecord known) {
    return known.block_key != kEmptyKey && observation_count(known) >= kLeastForSample;
}
