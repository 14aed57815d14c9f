#version 460
#extension GL_GOOGLE_include_directive : require
// One workgroup per segment of a batch: which of the records that it keeps are fitted, in an order that is the same in
// every run, so that sums over them are, too, and how blurred their highlights are. Records left out leave gaps.
// Hands on what the fits before found for each alpha.
#include "lib/records/reflectance.glsl"
#include "shared/specular/ward_fit.h"

layout(local_size_x = kDrawGroup) in;
layout(std430, binding = 0) readonly buffer Batch { uint batch[]; };  // count, then labels
layout(std430, binding = 1) readonly buffer Records { VoxelRecord records[]; };
layout(std430, binding = 2) readonly buffer Counts { SegmentSampleCount counts[]; };
layout(std430, binding = 3) readonly buffer Kept { uint kept[]; };
layout(std430, binding = 4) readonly buffer Visibility { uvec2 visibility[]; };
layout(std430, binding = 5) readonly buffer Status { RecordStatus status[]; };
layout(std430, binding = 6) readonly buffer Keys { uvec4 keys[]; };
layout(std430, binding = 7) readonly buffer Blocks { uint blocks[]; };
layout(std430, binding = 8) readonly buffer RecordTable { uint record_table[]; };
layout(std430, binding = 9) writeonly buffer Voxels { FitVoxel voxels[]; };  // kSegmentSamples per segment
layout(std430, binding = 10) readonly buffer Fits { WardFit fits[]; };
layout(std430, binding = 11) readonly buffer Curves { FitCurve curves[]; };  // kFitAlphas per label
layout(std430, binding = 12) writeonly buffer Before {
    vec4 ks_before[];
};  // kFitAlphas per segment; w: 1, or 0 for none
layout(push_constant) uniform Push { FitParams params; };
#define KEYS(bucket) keys[bucket]
#define BLOCK(slot) blocks[slot]
#define RECORD(entry) record_table[entry]
#include "lib/records/find_record.glsl"

shared uvec2 places[kSegmentSamples];

// Voxels that some light may reach only in part count too: faces whose sides were never seen have no others.
bool is_lit(uint record) {
    return is_marched(status[record].marched, params.position_version) && any(notEqual(visibility[record], uvec2(0u)));
}

bool is_before(uvec2 a, uvec2 b) { return a.x != b.x ? a.x < b.x : a.y < b.y; }

// Where a surface bends, an observation is a mean over the normals of about a pixel, and the voxel's own is less exact:
// its highlight is that of a rougher material (Toksvig 2005). The normals of the voxels beside it tell how much
// it bends. Balls of known materials, seen from 3 m with pixels of 8 mm, show kFitBlurM; interpolation between pixels
// alone makes 5 mm. No farther than one voxel: their normals err, too.
float blur2_of(VoxelRecord record) {
    const ivec3 voxel =
        voxel_of_record(block_of_key(params.records, record.block_key), voxel_in_block(record), params.edge_shift);
    const vec3 normal = surface_normal(record);
    float sum = 0.0, count = 0.0;
    for (int i = 0; i < 6; ++i) {
        ivec3 beside = voxel;
        beside[i >> 1] += 2 * (i & 1) - 1;
        const uint found = find_record(params.records, params.edge_shift, beside);
        const VoxelRecord other = records[found == kNoRecord ? 0u : found];
        const bool known =
            found != kNoRecord && surface_samples(other) > 0u && dot(surface_normal(other), normal) > kSameFaceCosine;
        const vec3 apart = surface_normal(other) - normal;
        sum += known ? dot(apart, apart) : 0.0;
        count += known ? 1.0 : 0.0;
    }
    const float steps = min(kFitBlurM / params.records.voxel_m, 1.0);
    return steps * steps * sum / max(count, 1.0);
}

void main() {
    const uint segment = gl_WorkGroupID.x;
    const uint label = batch[1u + segment];
    const uint count = label < params.labels ? min(counts[label].kept, kSegmentSamples) : 0u;
    for (uint i = gl_LocalInvocationIndex; i < count; i += kDrawGroup) {
        const VoxelRecord record = records[kept[label * kSegmentSamples + i]];
        places[i] = uvec2(record.block_key, voxel_in_block(record));
    }
    const bool fitted = label < params.labels && fits[min(label, params.labels - 1u)].estimates > 0u;
    for (uint a = gl_LocalInvocationIndex; a < kFitAlphas; a += kDrawGroup)
        ks_before[segment * kFitAlphas + a] = fitted ? vec4(curves[label * kFitAlphas + a].ks.rgb, 1.0) : vec4(0.0);
    barrier();
    for (uint i = gl_LocalInvocationIndex; i < kSegmentSamples; i += kDrawGroup) {
        uint rank = i;
        FitVoxel chosen = FitVoxel(kNoRecord, 0.0, uvec2(0u));
        if (i < count) {
            rank = 0u;
            for (uint other = 0u; other < count; ++other) rank += is_before(places[other], places[i]) ? 1u : 0u;
            const uint record = kept[label * kSegmentSamples + i];
            if (record_label(records[record]) == label && is_lit(record))
                chosen = FitVoxel(record, blur2_of(records[record]), status[record].incident);
        }
        voxels[segment * kSegmentSamples + rank] = chosen;
    }
}
