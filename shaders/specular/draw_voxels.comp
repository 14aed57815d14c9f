#version 460
#extension GL_GOOGLE_include_directive : require
// One workgroup per segment: draws kHemiSamples of the records that it keeps, those without enough observations left
// out. The draw is a random order by hash, so that the order in which they are kept does not matter. A segment of fewer
// has some of them several times.
#include "lib/math/random.glsl"
#include "lib/segments/segment_samples.glsl"
#include "shared/specular/hemi_images.h"

layout(local_size_x = kDrawGroup) in;
layout(std430, binding = 0) readonly buffer Batch { uint batch[]; };  // count, then labels
layout(std430, binding = 1) readonly buffer Records { VoxelRecord records[]; };
layout(std430, binding = 2) readonly buffer Counts { SegmentSampleCount counts[]; };
layout(std430, binding = 3) readonly buffer Kept { uint kept[]; };
layout(std430, binding = 4) writeonly buffer Drawn { uint drawn[]; };  // kHemiSamples per segment of the batch
layout(push_constant) uniform Push { HemiParams params; };

shared uint eligible;
shared uint ids[kSegmentSamples];
shared uint hashes[kSegmentSamples];
shared uvec2 voxels[kSegmentSamples];
shared uint candidate_count;
shared uint candidates[kSegmentSamples];
shared uint order[kHemiSamples];

const uint kMostHash = 0xffffffffu;

// Two voxels may have one hash, though hardly ever.
bool is_before(uint a, uint b) {
    if (hashes[a] != hashes[b]) return hashes[a] < hashes[b];
    return voxels[a].x != voxels[b].x ? voxels[a].x < voxels[b].x : voxels[a].y < voxels[b].y;
}

void collect(uint label) {
    const uint count = label < params.labels ? min(counts[label].kept, kSegmentSamples) : 0u;
    for (uint i = gl_LocalInvocationIndex; i < count; i += kDrawGroup) {
        const uint id = kept[label * kSegmentSamples + i];
        const VoxelRecord record = records[id];
        if (observation_count(record) < kLeastHemiObservations) continue;
        const uint slot = atomicAdd(eligible, 1u);
        ids[slot] = id;
        hashes[slot] = sample_hash(record, params.seed);
        voxels[slot] = uvec2(record.block_key, voxel_in_block(record));
    }
}

// The first records of the order, or all where there are fewer; only those with a hash of at most `most` are looked at.
void order_below(uint most) {
    for (uint i = gl_LocalInvocationIndex; i < eligible; i += kDrawGroup) {
        if (hashes[i] <= most) candidates[atomicAdd(candidate_count, 1u)] = i;
    }
    barrier();
    for (uint i = gl_LocalInvocationIndex; i < candidate_count; i += kDrawGroup) {
        uint rank = 0u;
        for (uint other = 0u; other < candidate_count; ++other) {
            rank += is_before(candidates[other], candidates[i]) ? 1u : 0u;
        }
        if (rank < kHemiSamples) order[rank] = ids[candidates[i]];
    }
    barrier();
}

void main() {
    const uint segment = gl_WorkGroupID.x, draw = gl_LocalInvocationIndex;
    if (draw == 0u) eligible = candidate_count = 0u;
    barrier();
    collect(batch[1u + segment]);
    barrier();
    // Twice as many as are drawn are almost surely enough, and ranking takes the square of their number.
    const uint share = 2u * kHemiSamples;
    order_below(eligible <= share ? kMostHash : kMostHash / eligible * share);
    if (candidate_count < min(eligible, kHemiSamples)) {
        barrier();
        if (draw == 0u) candidate_count = 0u;
        barrier();
        order_below(kMostHash);
    }
    if (draw >= kHemiSamples) return;
    uint chosen = draw;
    if (eligible < kHemiSamples) chosen = hash_words(uvec4(params.seed, draw, 0u, 0u)).x % max(eligible, 1u);
    drawn[segment * kHemiSamples + draw] = eligible == 0u ? kNoRecord : order[chosen];
}
