#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// One workgroup per label: whether the colours of the records that it keeps are two, and where the line between them
// lies. Of the chromaticities along their principal axis the threshold of Otsu 1979; then, whether its two sides are
// apart in colour, also in albedo where that is known, and lie apart in space. All sums are of whole numbers: the order
// of what is kept does not matter.
#include "lib/map/voxel_chunks.glsl"
#include "lib/map/voxel_map.glsl"
#include "lib/records/reflectance.glsl"
#include "lib/segments/split_rule.glsl"

layout(local_size_x = kSplitGroup) in;
layout(std430, binding = 0) readonly buffer Records { VoxelRecord records[]; };
layout(std430, binding = 1) readonly buffer Counts { SegmentSampleCount counts[]; };
layout(std430, binding = 2) readonly buffer Kept { uint kept[]; };
layout(std430, binding = 3) readonly buffer Labels { SegmentLabel labels[]; };
layout(std430, binding = 4) readonly buffer Partners { uint partners[]; };
layout(std430, binding = 5) writeonly buffer Proposals { SplitProposal proposals[]; };
layout(std430, binding = 6) readonly buffer Albedo { uvec2 albedo[]; };
layout(std430, binding = 7) readonly buffer Colors { uvec4 quads[]; }
colors[kMaxVoxelChunks];
layout(push_constant) uniform Push { FindSplitsParams params; };
#include "lib/records/mean_color.glsl"

const float kMostMixed = 0.4;     // of nearest records of the other colour, over as many as there were by chance
const float kMostBetween = 0.17;  // share of all that lies in the middle half of what is between the two means
const float kAlbedoShare = 0.5;   // of the least difference of chromaticities, for those of the albedo
const uint kFar = 0xffffffffu;
const ivec2 kUnknown = ivec2(-1);

shared ivec2 chromas[kSegmentSamples];     // in steps of kSplitStep
shared ivec2 kd_chromas[kSegmentSamples];  // likewise, or kUnknown
shared ivec3 voxels[kSegmentSamples];
shared uint listed;
shared int sums[5];  // of r, g, and about the mean of r r, r g, g g
shared int least, most;
shared uint bin_counts[kSplitBins];
shared int bin_sums[kSplitBins];  // of places along the axis
shared float threshold;
shared bool is_apart;
shared uint count_beyond;
shared uint crossing;
shared ivec3 kd_sums[2];  // of the chromaticities of kd below and beyond the threshold, and how many

ivec2 kd_chroma(uvec2 stored) {
    const vec3 certainty = albedo_certainty(stored), kd = albedo_kd(stored);
    const bool known = min(min(certainty.r, certainty.g), certainty.b) >= kLeastKdCertainty && has_chroma(kd);
    return known ? ivec2(round(chroma_of(kd) / kSplitStep)) : kUnknown;
}

// Lists the records that have a chromaticity.
void list_colors(uint label, uint count) {
    for (uint i = gl_LocalInvocationIndex; i < count; i += kSplitGroup) {
        const uint id = kept[label * kSegmentSamples + i];
        const VoxelRecord record = records[id];
        const vec3 color = mean_color(params.records.chunk_shift, id, observation_count(record));
        if (!has_chroma(color)) continue;
        const uint place = atomicAdd(listed, 1u);
        chromas[place] = ivec2(round(chroma_of(color) / kSplitStep));
        kd_chromas[place] = kd_chroma(albedo[id]);
        voxels[place] =
            voxel_of_record(block_of_key(params.records, record.block_key), voxel_in_block(record), params.edge_shift);
    }
}

// The direction in which chromaticities spread most.
vec2 principal_axis(uint count) {
    for (uint i = gl_LocalInvocationIndex; i < count; i += kSplitGroup) {
        atomicAdd(sums[0], chromas[i].x);
        atomicAdd(sums[1], chromas[i].y);
    }
    barrier();
    const ivec2 mean = ivec2(sums[0], sums[1]) / int(count);
    for (uint i = gl_LocalInvocationIndex; i < count; i += kSplitGroup) {
        const ivec2 off = chromas[i] - mean;
        atomicAdd(sums[2], off.x * off.x);
        atomicAdd(sums[3], off.x * off.y);
        atomicAdd(sums[4], off.y * off.y);
    }
    barrier();
    const float rr = float(sums[2]), rg = float(sums[3]), gg = float(sums[4]);
    const float larger = 0.5 * (rr + gg + sqrt((rr - gg) * (rr - gg) + 4.0 * rg * rg));
    const vec2 axis = rr >= gg ? vec2(larger - gg, rg) : vec2(rg, larger - rr);
    return dot(axis, axis) > 0.0 ? normalize(axis) : vec2(1.0, 0.0);
}

int place_along(vec2 axis, ivec2 chroma) { return int(round(dot(axis, vec2(chroma)))); }

// Counts and sums of the places along the axis, by bins between the least and the largest.
void fill_bins(vec2 axis, uint count) {
    for (uint i = gl_LocalInvocationIndex; i < count; i += kSplitGroup) {
        const int place = place_along(axis, chromas[i]);
        atomicMin(least, place);
        atomicMax(most, place);
    }
    barrier();
    const int range = max(most - least, 1);
    for (uint i = gl_LocalInvocationIndex; i < count; i += kSplitGroup) {
        const int place = place_along(axis, chromas[i]) - least;
        const uint bin = min(uint(place) * kSplitBins / uint(range), kSplitBins - 1u);
        atomicAdd(bin_counts[bin], 1u);
        atomicAdd(bin_sums[bin], place);
    }
    barrier();
}

struct Part {
    float count, sum;
};
float mean_of(Part part) { return part.sum / max(part.count, 1.0); }

// The bins below `bin`, or all of them.
Part part_below(uint bin) {
    Part part = Part(0.0, 0.0);
    for (uint i = 0u; i < bin; ++i) {
        part.count += float(bin_counts[i]);
        part.sum += float(bin_sums[i]);
    }
    return part;
}
Part rest_of(Part all, Part part) { return Part(all.count - part.count, all.sum - part.sum); }

// How many lie about half-way between two places, in bins.
float count_between(float low, float high) {
    const float bins_per_step = float(kSplitBins) / float(max(most - least, 1));
    const float first = mix(low, high, 0.25) * bins_per_step, last = mix(low, high, 0.75) * bins_per_step;
    uint count = 0u;
    for (uint i = 0u; i < kSplitBins; ++i)
        count += float(i) + 0.5 > first && float(i) + 0.5 < last ? bin_counts[i] : 0u;
    return float(count);
}

// By one invocation: Otsu's two parts, and half-way between their means the threshold. Whether both are narrow and
// apart.
bool find_threshold() {
    const Part all = part_below(kSplitBins);
    uint best = 0u;
    float best_between = 0.0;
    Part below = Part(0.0, 0.0);
    for (uint bin = 1u; bin < kSplitBins; ++bin) {
        below.count += float(bin_counts[bin - 1u]);
        below.sum += float(bin_sums[bin - 1u]);
        const Part beyond = rest_of(all, below);
        const float apart = mean_of(beyond) - mean_of(below);
        const float between = below.count * beyond.count * apart * apart;
        if (min(below.count, beyond.count) > 0.0 && between > best_between) {
            best_between = between;
            best = bin;
        }
    }
    below = part_below(best);
    const Part beyond = rest_of(all, below);
    threshold = float(least) + 0.5 * (mean_of(beyond) + mean_of(below));
    const bool gap = count_between(mean_of(below), mean_of(beyond)) <= kMostBetween * all.count;
    return gap && (mean_of(beyond) - mean_of(below)) * kSplitStep >= params.least_apart;
}

// How many lie beyond the threshold; 0 where either part is too small.
uint count_parts(vec2 axis, uint count) {
    for (uint i = gl_LocalInvocationIndex; i < count; i += kSplitGroup) {
        if (float(place_along(axis, chromas[i])) > threshold) atomicAdd(count_beyond, 1u);
    }
    barrier();
    const uint beyond = count_beyond;
    const float least_part = max(float(kLeastSplitPart), kLeastSplitShare * float(count));
    return float(min(beyond, count - beyond)) >= least_part ? beyond : 0u;
}

// Whether the albedos are known to be less apart than the colours: highlights are what differs.
bool is_one_albedo(vec2 axis, uint count) {
    for (uint i = gl_LocalInvocationIndex; i < count; i += kSplitGroup) {
        if (kd_chromas[i] == kUnknown) continue;
        const uint side = float(place_along(axis, chromas[i])) > threshold ? 1u : 0u;
        atomicAdd(kd_sums[side].x, kd_chromas[i].x);
        atomicAdd(kd_sums[side].y, kd_chromas[i].y);
        atomicAdd(kd_sums[side].z, 1);
    }
    barrier();
    const ivec3 below = kd_sums[0], beyond = kd_sums[1];
    if (min(below.z, beyond.z) < int(kLeastKdSamples)) return false;
    const vec2 apart = vec2(beyond.xy) / float(beyond.z) - vec2(below.xy) / float(below.z);
    return length(apart) * kSplitStep < kAlbedoShare * params.least_apart;
}

// How many records have a nearer one of the other colour than of their own.
void count_crossing(vec2 axis, uint count) {
    for (uint i = gl_LocalInvocationIndex; i < count; i += kSplitGroup) {
        const bool side = float(place_along(axis, chromas[i])) > threshold;
        uint nearest_same = kFar, nearest_other = kFar;
        for (uint j = 0u; j < count; ++j) {
            const ivec3 off = voxels[j] - voxels[i];
            const uint distance2 = uint(off.x * off.x) + uint(off.y * off.y) + uint(off.z * off.z);
            const bool same = (float(place_along(axis, chromas[j])) > threshold) == side;
            if (same && i != j) nearest_same = min(nearest_same, distance2);
            if (!same) nearest_other = min(nearest_other, distance2);
        }
        if (nearest_other < nearest_same) atomicAdd(crossing, 1u);
    }
    barrier();
}

void main() {
    const uint label = group_item(gl_WorkGroupID), lane = gl_LocalInvocationIndex;
    if (label >= params.labels) return;
    const uint kept_count = min(counts[label].kept, kSegmentSamples);
    const SegmentLabel known = labels[label];
    const bool may_split =
        known.state == kLiveLabel && partners[label] == kNoLabel && params.stamp - known.since >= kLeastSplitAge;
    if (kept_count < kLeastSplitSamples || !may_split) return;
    if (lane == 0u) {
        listed = crossing = count_beyond = 0u;
        least = 0x7fffffff;
        most = -0x7fffffff;
    }
    if (lane < 5u) sums[lane] = 0;
    if (lane < 2u) kd_sums[lane] = ivec3(0);
    for (uint bin = lane; bin < kSplitBins; bin += kSplitGroup) {
        bin_counts[bin] = 0u;
        bin_sums[bin] = 0;
    }
    barrier();
    list_colors(label, kept_count);
    barrier();
    const uint count = listed;
    if (count < kLeastSplitSamples) return;
    const vec2 axis = principal_axis(count);
    fill_bins(axis, count);
    if (lane == 0u) is_apart = find_threshold();
    barrier();
    if (!is_apart) return;
    const uint beyond = count_parts(axis, count);
    if (beyond == 0u) return;
    if (is_one_albedo(axis, count)) return;
    count_crossing(axis, count);
    const float by_chance = 2.0 * float(beyond) * float(count - beyond) / float(count);
    if (lane != 0u || float(crossing) > kMostMixed * by_chance) return;
    // The fewer lie beyond.
    const float sign = 2u * beyond > count ? -1.0 : 1.0;
    const SplitRule rule = SplitRule(sign * axis.x, sign * axis.y, sign * threshold * kSplitStep, 0u);
    proposals[label] = SplitProposal(rule, min(beyond, count - beyond), 0u, 0u, 0u);
}
