#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// The gain of one channel per group from its histogram: the median, then a few steps of Tukey's biweight mean around
// it, which no minority of highlights or changed surfaces moves. Sums have a fixed shape.
#include "shared/photometry/color_gains.h"

layout(local_size_x = kSettleGainsGroup) in;
layout(std430, binding = 0) readonly buffer Histogram { uint weights[]; };
layout(std430, binding = 1) buffer Gains { ColorGains gains; };
layout(push_constant) uniform Push { SettleGainsParams params; };

const uint kOwnBins = kGainBins / kSettleGainsGroup;
const float kLeastReach = 6.0;  // bins, 3 %: a biweight mean of less would follow single bins
// Quantiles this far to both sides of the median: a third of the samples may lie far off to one side. Of a normal
// distribution they are 0.385 sigma away, so that the mean reaches to 2.7 sigma.
const float kQuantileStep = 0.15;
const float kReachOfQuantiles = 7.0;
const uint kSteps = 3u;

shared uint ends[kSettleGainsGroup];  // the weight of an invocation's bins and those before
shared float quantiles[3];            // the middle one is the median; in bins
shared vec2 sums[kSettleGainsGroup];

uint own[kOwnBins];

void add_up_ends() {
    const uint lane = gl_LocalInvocationIndex;
    for (uint reach = 1u; reach < kSettleGainsGroup; reach *= 2u) {
        const uint before = lane >= reach ? ends[lane - reach] : 0u;
        barrier();
        ends[lane] += before;
        barrier();
    }
}

// Whoever holds a quantile writes where it lies, as if weights were spread evenly over their bin.
void find_quantiles(uint total) {
    const uint lane = gl_LocalInvocationIndex;
    const uint begin = lane > 0u ? ends[lane - 1u] : 0u;
    [[unroll]] for (uint q = 0u; q < 3u; ++q) {
        const float rank = float(total) * (0.5 + kQuantileStep * (float(q) - 1.0));
        float below = float(begin);
        [[unroll]] for (uint i = 0u; i < kOwnBins; ++i) {
            const float weight = float(own[i]);
            if (rank > below && rank <= below + weight)
                quantiles[q] = float(lane * kOwnBins + i) - 0.5 + (rank - below) / weight;
            below += weight;
        }
    }
    barrier();
}

vec2 total_of(vec2 value) {
    const uint lane = gl_LocalInvocationIndex;
    sums[lane] = value;
    barrier();
    for (uint half_size = kSettleGainsGroup / 2u; half_size > 0u; half_size /= 2u) {
        if (lane < half_size) sums[lane] += sums[lane + half_size];
        barrier();
    }
    const vec2 total = sums[0];
    barrier();
    return total;
}

float biweight_mean(float center, float reach) {
    for (uint step = 0u; step < kSteps; ++step) {
        vec2 sum = vec2(0.0);
        [[unroll]] for (uint i = 0u; i < kOwnBins; ++i) {
            const float off = float(gl_LocalInvocationIndex * kOwnBins + i) - center;
            const float share = max(1.0 - off * off / (reach * reach), 0.0);
            sum += vec2(off, 1.0) * (share * share * float(own[i]));
        }
        const vec2 total = total_of(sum);
        center += total.x / max(total.y, 1.0);
    }
    return center;
}

void main() {
    const uint lane = gl_LocalInvocationIndex;
    const uint channel = gl_WorkGroupID.x;
    uint weight = 0u;
    [[unroll]] for (uint i = 0u; i < kOwnBins; ++i) {
        own[i] = weights[channel * kGainBins + lane * kOwnBins + i];
        weight += own[i];
    }
    ends[lane] = weight;
    barrier();
    add_up_ends();
    const uint samples = weights[3u * kGainBins + channel];
    if (samples >= params.min_samples) {
        find_quantiles(ends[kSettleGainsGroup - 1u]);
        const float reach = max(0.5 * kReachOfQuantiles * (quantiles[2] - quantiles[0]), kLeastReach);
        const float bin = biweight_mean(quantiles[1], reach);
        const float stops = (bin / kGainBinsPerStop - kGainRangeStops) * (1.0 - params.leak);
        if (lane == 0u) gains.gain[channel] = exp2(stops);
    }
    if (lane == 0u) gains.samples[channel] = samples;
}
