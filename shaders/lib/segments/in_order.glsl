// Work of one workgroup that depends on the order of its items: each invocation takes consecutive ones. The includer
// declares kGroup, the number of invocations.
#ifndef PATINA_LIB_IN_ORDER_GLSL
#define PATINA_LIB_IN_ORDER_GLSL

shared uint partial_counts[kGroup];

// The range of `count` items, from 1 on, that this invocation takes.
uvec2 own_items(uint count) {
    const uint each = (count + kGroup - 1u) / kGroup;
    const uint first = min(gl_LocalInvocationIndex * each, count);
    return uvec2(1u + first, 1u + min(first + each, count));
}

// The sum of what the invocations before this one have; `total` is that of all.
uint sum_before(uint mine, out uint total) {
    partial_counts[gl_LocalInvocationIndex] = mine;
    barrier();
    uint before = 0u;
    total = 0u;
    for (uint i = 0u; i < kGroup; ++i) {
        before += i < gl_LocalInvocationIndex ? partial_counts[i] : 0u;
        total += partial_counts[i];
    }
    barrier();
    return before;
}

#endif
