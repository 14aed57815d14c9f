// Disjoint sets as trees whose parents are smaller than their children; roots are their own parents. Any number of
// invocations may unite sets at once: a parent only ever becomes smaller, and a stale one leads to the same root
// (Komura 2015; Playne and Hawick 2018). The includer declares, before it includes this,
//   layout(std430, binding = n) coherent buffer Parents { uint parents[]; };
#ifndef PATINA_LIB_DISJOINT_SETS_GLSL
#define PATINA_LIB_DISJOINT_SETS_GLSL

uint find_root(uint element) {
    uint parent = parents[element];
    while (parent != element) {
        element = parent;
        parent = parents[element];
    }
    return element;
}

void unite(uint a, uint b) {
    a = find_root(a);
    b = find_root(b);
    while (a != b) {
        const uint low = min(a, b);
        const uint high = max(a, b);
        const uint before = atomicMin(parents[high], low);
        // `high` was no root any more: what it belonged to belongs to `low` too.
        a = find_root(low);
        b = before == high ? a : find_root(before);
    }
}

#endif
