#version 460
#extension GL_GOOGLE_include_directive : require
// Gives every segment of the frame a label: that of the map which it shares most with, or a new one. Joins labels that
// segments have often enough said to be one, and once in a sweep prunes labels and takes back those that nothing holds
// any more. One workgroup; whatever depends on an order is done in that of segments or labels.
#include "lib/color/luminance.glsl"
#include "lib/map/voxel_map.glsl"
#include "shared/segmentation/frame_segments.h"
#include "shared/segmentation/segment_samples.h"
#include "shared/segmentation/segments.h"
#include "shared/specular/ward_fit.h"

layout(local_size_x = kAssignLabelsGroup) in;
layout(std430, binding = 0) readonly buffer Segments { FrameSegment segments[]; };
layout(std430, binding = 1) readonly buffer SegmentCount { FrameSegmentCount segment_count; };
layout(std140, binding = 2) uniform Segmentation { SegmentationParams frame; };
layout(std430, binding = 3) readonly buffer Overlaps { SegmentOverlap overlaps[]; };
layout(std430, binding = 4) readonly buffer OverlapList { uint overlap_list[]; };
layout(std430, binding = 5) coherent buffer Votes { SegmentVote votes[]; };
layout(std430, binding = 6) coherent buffer SegmentLabels { uint segment_labels[]; };  // zero at first
layout(std430, binding = 7) coherent buffer Parents { uint parents[]; };
layout(std430, binding = 8) coherent buffer Labels { SegmentLabel labels[]; };
layout(std430, binding = 9) coherent buffer Pairs { SegmentPair pairs[]; };
layout(std430, binding = 10) coherent buffer FreeLabels { uint free_labels[]; };
layout(std430, binding = 11) coherent buffer Counters { SegmentCounters counters; };
layout(std430, binding = 12) coherent buffer SegmentKds { SegmentKd kds[]; };
layout(std430, binding = 13) readonly buffer Fits { WardFit fits[]; };
layout(std430, binding = 14) coherent buffer Partners { uint partners[]; };
layout(std430, binding = 15) coherent buffer Rules { SplitRule rules[]; };

const uint kGroup = kAssignLabelsGroup;
const uint kNone = 0xffffffffu;
const float kKdError = 0.01;  // of a segment's mean: light that was not accounted for does so much to dark surfaces
const float kSureFit = 0.5;   // confidence of a specular fit that counts

#include "lib/segments/in_order.glsl"

shared uint merged;

void join() {
    memoryBarrierBuffer();
    barrier();
}

void find_best(uint entries) {
    const uint lane = gl_LocalInvocationIndex;
    for (uint i = lane; i < entries; i += kGroup) {
        const SegmentOverlap entry = overlaps[overlap_list[1u + i]];
        atomicMax(votes[entry.key >> 16].best_pixels, entry.pixels);
        atomicAdd(votes[entry.key >> 16].known_pixels, entry.pixels);
    }
    join();
    for (uint i = lane; i < entries; i += kGroup) {
        const SegmentOverlap entry = overlaps[overlap_list[1u + i]];
        const uint s = entry.key >> 16;
        if (entry.pixels == votes[s].best_pixels) atomicMin(votes[s].best_label, entry.key & 0xffffu);
    }
    join();
    for (uint i = lane; i < entries; i += kGroup) {
        const SegmentOverlap entry = overlaps[overlap_list[1u + i]];
        const uint s = entry.key >> 16;
        if ((entry.key & 0xffffu) != votes[s].best_label) atomicMax(votes[s].second_pixels, entry.pixels);
    }
    join();
    for (uint i = lane; i < entries; i += kGroup) {
        const SegmentOverlap entry = overlaps[overlap_list[1u + i]];
        const uint s = entry.key >> 16, label = entry.key & 0xffffu;
        if (label != votes[s].best_label && entry.pixels == votes[s].second_pixels)
            atomicMin(votes[s].second_label, label);
    }
    join();
}

// Where the map knows most of a segment a new label would be one more among the pieces.
bool is_mostly_known(SegmentVote vote, uint pixels) { return 2u * vote.known_pixels > pixels; }

bool inherits(SegmentVote vote, uint pixels) {
    const bool enough = float(vote.best_pixels) > frame.inherit_share * float(pixels) || is_mostly_known(vote, pixels);
    return vote.best_pixels >= frame.inherit_pixels && enough;
}

bool starts(SegmentVote vote, uint pixels) {
    return pixels >= frame.new_pixels && !inherits(vote, pixels) && !is_mostly_known(vote, pixels);
}

bool joins(SegmentVote vote, uint pixels) {
    return inherits(vote, pixels) && vote.second_pixels >= frame.inherit_pixels &&
           float(vote.second_pixels) > frame.merge_share * float(pixels);
}

void start_label(uint label) {
    labels[label] = SegmentLabel(kLiveLabel, frame.stamp, frame.stamp, 0u, 0u, 0u, 0u, 0u);
    kds[label] = SegmentKd(0u, 0u, 0u, 0u);
    parents[label] = label;
    partners[label] = kNoLabel;
    atomicMax(counters.high_water, label + 1u);
}

// Inherited labels, then new ones in the order of segments.
void assign_propagated(uint count) {
    const uvec2 own = own_items(count);
    uint wanted = 0u;
    for (uint s = own.x; s < own.y; ++s) {
        const SegmentVote vote = votes[s];
        const uint pixels = segments[s].pixels;
        const bool known = inherits(vote, pixels);
        segment_labels[s] = known ? vote.best_label : kNoLabel;
        if (known) labels[vote.best_label].seen = frame.stamp;
        wanted += starts(vote, pixels) ? 1u : 0u;
    }
    uint total;
    uint next = sum_before(wanted, total);
    const uint available = counters.free_labels;
    for (uint s = own.x; s < own.y; ++s) {
        if (!starts(votes[s], segments[s].pixels)) continue;
        if (next < available) {
            const uint label = free_labels[(counters.free_head + next) % frame.capacity];
            start_label(label);
            segment_labels[s] = label;
        }
        ++next;
    }
    join();
    if (gl_LocalInvocationIndex != 0u) return;
    const uint granted = min(total, available);
    counters.free_head = (counters.free_head + granted) % frame.capacity;
    counters.free_labels = available - granted;
    counters.live += granted;
    counters.created += granted;
    counters.refused += total - granted;
}

void assign_given(uint count) {
    const uvec2 own = own_items(count);
    uint started = 0u, refused = 0u;
    for (uint s = own.x; s < own.y; ++s) {
        const uint label = segments[s].key;
        const bool fits = label < frame.capacity;
        refused += fits ? 0u : 1u;
        segment_labels[s] = fits ? label : kNoLabel;
        if (!fits) continue;
        // No two segments have the same given id.
        if (labels[label].state != kLiveLabel) {
            start_label(label);
            ++started;
        }
        labels[label].seen = frame.stamp;
    }
    uint all_started, all_refused;
    sum_before(started, all_started);
    sum_before(refused, all_refused);
    if (gl_LocalInvocationIndex != 0u) return;
    counters.live += all_started;
    counters.created += all_started;
    counters.refused += all_refused;
}

// The counter of a pair of labels: its own, a free one, or that of the pair of its bucket which was seen least.
uint find_pair(uint key) {
    const uint first = hash_of_key(key) % kPairBuckets * kPairWays;
    uint least = first;
    for (uint i = first; i < first + kPairWays; ++i) {
        if (pairs[i].count > 0u && pairs[i].labels == key) return i;
        if (pairs[i].count < pairs[least].count) least = i;
    }
    pairs[least] = SegmentPair(key, 0u, 0u, 0u);
    return least;
}

bool same_chroma(uint a, uint b) {
    const vec3 one = vec3(labels[a].chroma_samples, labels[a].chroma_r, labels[a].chroma_g);
    const vec3 two = vec3(labels[b].chroma_samples, labels[b].chroma_r, labels[b].chroma_g);
    if (min(one.x, two.x) < 1.0) return false;
    const vec2 apart = abs(one.yz / one.x - two.yz / two.x) * (1.0 / kChromaSteps);
    return max(apart.x, apart.y) <= frame.merge_chroma;
}

bool is_kd_known(uint label) { return kds[label].samples >= kLeastKdSamples; }

vec3 mean_kd(uint label) {
    const SegmentKd sums = kds[label];
    return vec3(sums.r, sums.g, sums.b) / (float(sums.samples) * kKdSteps);
}

// Light and shadow are not in kd: brightness says as much as chromaticity does, but for errors of dark colours.
bool same_kd(uint a, uint b) {
    const vec3 one = mean_kd(a), two = mean_kd(b);
    const float one_sum = max(one.r + one.g + one.b, 1e-3), two_sum = max(two.r + two.g + two.b, 1e-3);
    const vec2 apart = abs(one.rg / one_sum - two.rg / two_sum);
    const float darker = min(luminance(one), luminance(two)), brighter = max(luminance(one), luminance(two));
    return max(apart.x, apart.y) <= frame.merge_chroma + kKdError / min(one_sum, two_sum) &&
           brighter <= frame.merge_brightness * darker + kKdError;
}

bool is_gloss_known(uint label) {
    return label < uint(fits.length()) && fits[label].estimates > 0u && fits[label].confidence >= kSureFit;
}

bool same_gloss(uint a, uint b) {
    const vec4 one = fits[a].ks_alpha, two = fits[b].ks_alpha;
    const vec3 apart = abs(one.rgb - two.rgb);
    return max(max(apart.r, apart.g), apart.b) <= frame.merge_ks &&
           max(one.a, two.a) <= frame.merge_alpha * min(one.a, two.a);
}

// What is known of both has to agree. A label and its partner, whose colours differ, need albedos that do not:
// highlights were what differed.
bool same_material(uint a, uint b) {
    if (partners[a] == b && !(is_kd_known(a) && is_kd_known(b))) return false;
    if (is_gloss_known(a) && is_gloss_known(b) && !same_gloss(a, b)) return false;
    return is_kd_known(a) && is_kd_known(b) ? same_kd(a, b) : same_chroma(a, b);
}

// A label keeps its partner under its new name, unless that has one. What was split in vain is its own partner: it is
// not split again.
void keep_partner(uint into, uint label) {
    const uint partner = partners[label];
    if (partner == kNoLabel || partner == label) return;
    if (partner == into) {
        partners[into] = into;
        return;
    }
    const bool takes = partners[into] == kNoLabel;
    if (partners[partner] == label) partners[partner] = takes ? into : kNoLabel;
    if (!takes) return;
    partners[into] = partner;
    rules[into] = rules[label];
}

void merge_labels(uint into, uint label) {
    parents[label] = into;
    keep_partner(into, label);
    kds[into].samples += kds[label].samples;
    kds[into].r += kds[label].r;
    kds[into].g += kds[label].g;
    kds[into].b += kds[label].b;
    labels[into].chroma_samples += labels[label].chroma_samples;
    labels[into].chroma_r += labels[label].chroma_r;
    labels[into].chroma_g += labels[label].chroma_g;
    labels[into].since = min(labels[into].since, labels[label].since);
    labels[into].voxels += labels[label].voxels;
    labels[into].tally += labels[label].tally;
    labels[label].state = kRetiredLabel;
    labels[label].since = frame.stamp;
    counters.live -= 1u;
    counters.merged += 1u;
    counters.frame_merged += 1u;
}

// In the order of segments, by one invocation: a frame has few such segments.
void count_pairs(uint count) {
    for (uint s = 1u; s <= count; ++s) {
        const SegmentVote vote = votes[s];
        if (!joins(vote, segments[s].pixels)) continue;
        const uint low = min(vote.best_label, vote.second_label), high = max(vote.best_label, vote.second_label);
        // One of them may have been merged by a segment before this one.
        if (parents[low] != low || parents[high] != high) continue;
        const uint pair = find_pair(low | high << 16);
        if (pairs[pair].stamp == frame.stamp) continue;
        pairs[pair].stamp = frame.stamp;
        pairs[pair].count += 1u;
        if (pairs[pair].count < frame.merge_count || !same_material(low, high)) continue;
        // The one that more was seen of keeps its name; of equal ones the smaller.
        const bool keeps_low = labels[low].chroma_samples >= labels[high].chroma_samples;
        merge_labels(keeps_low ? low : high, keeps_low ? high : low);
        merged = 1u;
    }
}

// Pairs that are seen side by side, and not as one.
void discount_pairs() {
    for (uint i = gl_LocalInvocationIndex; i < kPairBuckets * kPairWays; i += kGroup) {
        const SegmentPair pair = pairs[i];
        if (pair.count == 0u) continue;
        const uint low = pair.labels & 0xffffu, high = pair.labels >> 16;
        const bool live = parents[low] == low && parents[high] == high;
        const bool apart =
            pair.stamp != frame.stamp && labels[low].seen == frame.stamp && labels[high].seen == frame.stamp;
        if (!live) pairs[i].count = 0u;
        if (live && apart) pairs[i].count = pair.count - 1u;
    }
}

void compress() {
    for (uint label = 1u + gl_LocalInvocationIndex; label < counters.high_water; label += kGroup) {
        uint root = parents[label];
        while (root != kNoLabel && parents[root] != root) root = parents[root];
        parents[label] = root;
    }
}

// When a sweep has ended: what it counted, and which labels nothing holds any more.
void end_sweep() {
    const uvec2 own = own_items(counters.high_water - 1u);
    uint freed = 0u, pruned = 0u;
    for (uint label = own.x; label < own.y; ++label) {
        SegmentLabel known = labels[label];
        known.voxels = known.tally;
        known.tally = 0u;
        if (known.chroma_samples > kMostChromaSamples) {
            known.chroma_samples /= 2u;
            known.chroma_r /= 2u;
            known.chroma_g /= 2u;
        }
        const uint age = frame.stamp - known.since;
        if (known.state == kRetiredLabel && age > kSweepFrames) ++freed;
        const bool lost = known.state == kLiveLabel && age > kSweepFrames && known.voxels < frame.prune_voxels &&
                          frame.stamp - known.seen > frame.prune_frames;
        if (lost && frame.given == 0u) {
            known.state = kRetiredLabel;
            known.since = frame.stamp;
            parents[label] = kNoLabel;
            ++pruned;
        }
        labels[label] = known;
    }
    join();
    // What was given up is nobody's partner.
    for (uint label = own.x; label < own.y; ++label) {
        if (partners[label] != kNoLabel && parents[partners[label]] != partners[label]) partners[label] = kNoLabel;
    }
    uint all_freed, all_pruned;
    uint next = counters.free_head + counters.free_labels + sum_before(freed, all_freed);
    sum_before(pruned, all_pruned);
    for (uint label = own.x; label < own.y; ++label) {
        if (labels[label].state != kRetiredLabel || frame.stamp - labels[label].since <= kSweepFrames) continue;
        free_labels[next++ % frame.capacity] = label;
        labels[label] = SegmentLabel(kFreeLabel, frame.stamp, 0u, 0u, 0u, 0u, 0u, 0u);
        parents[label] = kNoLabel;
        partners[label] = kNoLabel;
    }
    join();
    if (gl_LocalInvocationIndex == 0u) {
        counters.free_labels += all_freed;
        counters.live -= all_pruned;
        counters.pruned += all_pruned;
    }
    join();
}

void propagate(uint count) {
    find_best(overlap_list[0]);
    assign_propagated(count);
    join();
    if (gl_LocalInvocationIndex == 0u) count_pairs(count);
    join();
    discount_pairs();
    join();
    if (merged == 0u) return;
    compress();
    join();
    for (uint s = 1u + gl_LocalInvocationIndex; s <= count; s += kGroup) segment_labels[s] = parents[segment_labels[s]];
}

void main() {
    const uint lane = gl_LocalInvocationIndex;
    const uint count = segment_count.segments;
    const bool overflow = overlap_list[0] >= frame.overlap_slots / 4u * 3u;
    for (uint s = lane; s <= count; s += kGroup) votes[s] = SegmentVote(kNone, 0u, kNone, 0u, 0u, 0u, 0u, 0u);
    if (lane == 0u) {
        merged = 0u;
        counters.frame_merged = 0u;
        counters.frame_voxels = 0u;
        counters.frame_flips = 0u;
        counters.frame_due = 0u;
        counters.overflows += overflow ? 1u : 0u;
    }
    join();
    if (frame.given != 0u) {
        assign_given(count);
    } else if (!overflow) {
        propagate(count);
    }
    join();
    // After the assignment: what a segment of this frame has is not given up.
    if (frame.stamp % kSweepFrames == 0u) end_sweep();
}
