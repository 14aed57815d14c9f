// Body of the selection shaders, one workgroup each: decides which of this frame's new keys get a place in the pool.
// While the pool suffices, all do. Else the keys whose hash falls into the first bins do, as many whole bins as fit:
// the choice depends on the keys alone, not on who came first. The includer declares `counters` and
//   HASH(i)         uint, the hash of new key i
#include "lib/map/accepted_key.glsl"

layout(local_size_x = kSelectGroup) in;

shared uint bins[kAcceptBins];

void count_bins(uint total) {
    for (uint i = gl_LocalInvocationIndex; i < kAcceptBins; i += kSelectGroup) bins[i] = 0u;
    barrier();
    for (uint i = gl_LocalInvocationIndex; i < total; i += kSelectGroup) atomicAdd(bins[accept_bin(HASH(i))], 1u);
    barrier();
}

// Updates the counters of a pool of `capacity` places. Invocation 0 returns how many new keys there are, the others 0.
uint select_keys(uint capacity) {
    const uint total = counters.new_keys;
    const uint available = counters.free_blocks;
    const bool scarce = total > available;
    if (scarce) count_bins(total);
    if (gl_LocalInvocationIndex != 0u) return 0u;

    uint accepted = total;
    uint accepted_bins = kAcceptBins;
    if (scarce) {
        accepted = 0u;
        for (accepted_bins = 0u; accepted_bins < kAcceptBins; ++accepted_bins) {
            if (accepted + bins[accepted_bins] > available) break;
            accepted += bins[accepted_bins];
        }
    }
    counters.accepted_bins = accepted_bins;
    counters.claim_base = available;
    counters.claimed = 0u;
    counters.free_blocks = available - accepted;
    counters.high_water = max(counters.high_water, capacity - (available - accepted));
    counters.table_keys += total;
    counters.refused_blocks += total - accepted;
    counters.assign_keys = total;
    counters.new_keys = 0u;
    return total;
}
