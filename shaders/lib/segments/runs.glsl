// Runs of pixels (shared/segmentation/label_components.h). Functions without bindings.
#ifndef PATINA_LIB_RUNS_GLSL
#define PATINA_LIB_RUNS_GLSL
#include "shared/segmentation/label_components.h"

// Which bits are a run's first pixel.
uint run_starts(RunWord word) { return word.inside & (~word.left | 1u); }

// The first pixel of the run that `bit` belongs to.
uint run_start(uint left, uint bit) { return uint(findMSB((~left | 1u) & (0xffffffffu >> (31u - bit)))); }

// The pixels of the run that starts at `bit`.
uint run_length(RunWord word, uint bit) {
    const uint ends = ~(word.inside & word.left) & (0xfffffffeu << bit);
    return (ends == 0u ? 32u : uint(findLSB(ends))) - bit;
}

#endif
