// Adds an observation to a record: to its end, into one from the same direction, or, when it is full, in place of one
// of the two most similar (paper, Section 3.4). The includer declares
//   layout(std430, binding = n) buffer Directions { uvec4 quads[]; } directions[kMaxVoxelChunks];
//   layout(std430, binding = n) buffer Colors { uvec4 quads[]; } colors[kMaxVoxelChunks];
// A record keeps its closest pair of directions. So a new one is compared with 30 directions, not 31 with one another,
// and that is all where it is dropped, as most are once a voxel was seen from all around.
#include "lib/records/observations.glsl"
#include "lib/records/record_colors.glsl"
#include "lib/records/record_directions.glsl"

struct Insertion {
    uint count;         // of observations, afterwards
    bool changed;       // a direction, a colour or a clipping
    bool lost_closest;  // the record's closest pair has to be found anew
};

void store_direction(uint chunk_shift, uint record, uint item, uint word) {
    const uint index = index_in_chunk(chunk_shift, record) * kRecordQuads + item / 4u;
#define STORE_DIRECTION(C) directions[C].quads[index][item % 4u] = word
    WITH_CHUNK(chunk_shift, record, STORE_DIRECTION)
}
void store_color(uint chunk_shift, uint record, uint item, uint word) {
    const uint index = index_in_chunk(chunk_shift, record) * kRecordQuads + item / 4u;
#define STORE_COLOR(C) colors[C].quads[index][item % 4u] = word
    WITH_CHUNK(chunk_shift, record, STORE_COLOR)
}

struct Nearest {
    uint item;
    float distance2;
};

// Which of a record's first `count` directions is nearest to `at`; the first of several. Four at a time: unrolled
// whole, some devices take minutes to compile it.
Nearest find_nearest(uint chunk_shift, uint record, uint count, vec3 at) {
    Nearest nearest = Nearest(0u, kFarApart);
    for (uint quad = 0u; 4u * quad < count; ++quad) {
        const uvec4 words = load_directions(chunk_shift, record, quad);
        [[unroll]] for (uint i = 0u; i < 4u; ++i) {
            const uint item = 4u * quad + i;
            const float distance2 = item < count ? grid_distance2(direction_on_grid(words[i]), at) : kFarApart;
            nearest.item = distance2 < nearest.distance2 ? item : nearest.item;
            nearest.distance2 = min(nearest.distance2, distance2);
        }
    }
    return nearest;
}

// Which of the closest pair goes for a new one: the one whose next nearest neighbour is nearer, so that gaps are not
// widened; the later one when these are equal.
uint choose_dropped(uint chunk_shift, uint record, uvec2 pair, vec3 added) {
    const vec3 a = direction_on_grid(load_direction(chunk_shift, record, pair.x));
    const vec3 b = direction_on_grid(load_direction(chunk_shift, record, pair.y));
    vec2 next = vec2(grid_distance2(a, added), grid_distance2(b, added));
    for (uint quad = 0u; quad < kRecordQuads; ++quad) {
        const uvec4 words = load_directions(chunk_shift, record, quad);
        [[unroll]] for (uint i = 0u; i < 4u; ++i) {
            const uint item = 4u * quad + i;
            const bool other = item < kMaxObservations && item != pair.x && item != pair.y;
            const vec3 direction = direction_on_grid(words[i]);
            const vec2 apart = vec2(grid_distance2(a, direction), grid_distance2(b, direction));
            next = min(next, other ? apart : vec2(kFarApart));
        }
    }
    return next.x < next.y ? pair.x : pair.y;
}

// Averages an observation into one from the same direction, unless that has had enough: a resting camera soon changes
// nothing.
bool merge(uint chunk_shift, uint record, uint item, vec3 rgb, bvec3 clipped) {
    const uint word = load_direction(chunk_shift, record, item);
    const uint samples = observation_samples(word);
    if (samples >= kMostSamples) return false;
    const uint before = load_color(chunk_shift, record, item);
    const uint after = pack_shared_exponent(mix(unpack_shared_exponent(before), rgb, 1.0 / float(samples + 1u)));
    const uint flagged = word | pack_clipped(clipped);
    store_direction(chunk_shift, record, item, (flagged & 0x1fffffffu) | samples << 29);
    store_color(chunk_shift, record, item, after);
    return after != before || flagged != word;
}

// Of 31 observations one of the closest pair goes. Where the new one belongs to it, that is the new one: were it the
// other, a camera that moves slowly would drag its last observation along and leave nothing behind. The set's smallest
// distance never shrinks by this.
Insertion replace(uint chunk_shift, uint record, Nearest nearest, vec3 at, uint direction, uint color) {
    const uvec4 last = load_directions(chunk_shift, record, kRecordQuads - 1u);
    // Of pairs as close, the one that was there first counts.
    if (nearest.distance2 < uintBitsToFloat(last[kClosestDistance % 4u])) {
        return Insertion(kMaxObservations, false, false);
    }
    const uvec2 pair = uvec2(last[kClosestPair % 4u] & 0xffu, last[kClosestPair % 4u] >> 8);
    const uint dropped = choose_dropped(chunk_shift, record, pair, at);
    store_direction(chunk_shift, record, dropped, direction);
    store_color(chunk_shift, record, dropped, color);
    return Insertion(kMaxObservations, true, true);
}

// Adds an observation to a record that has `count`. Directions within sqrt(merge_distance2) grid steps are the same.
Insertion insert_observation(uint chunk_shift, uint record, uint count, vec3 direction, vec3 rgb, bvec3 clipped,
                             float merge_distance2) {
    const uint word = pack_direction(direction, clipped, 1u);
    const vec3 at = direction_on_grid(word);
    const Nearest nearest = find_nearest(chunk_shift, record, count, at);
    if (nearest.distance2 <= merge_distance2) {
        return Insertion(count, merge(chunk_shift, record, nearest.item, rgb, clipped), false);
    }
    const uint color = pack_shared_exponent(rgb);
    if (count == kMaxObservations) return replace(chunk_shift, record, nearest, at, word, color);
    store_direction(chunk_shift, record, count, word);
    store_color(chunk_shift, record, count, color);
    const float closest =
        count < 2u ? kFarApart : uintBitsToFloat(load_direction(chunk_shift, record, kClosestDistance));
    if (count > 0u && nearest.distance2 < closest) {
        store_direction(chunk_shift, record, kClosestDistance, floatBitsToUint(nearest.distance2));
        store_direction(chunk_shift, record, kClosestPair, nearest.item | count << 8);
    }
    return Insertion(count + 1u, true, false);
}
