// Which of two labels a colour is of (shared/segmentation/split_labels.h). Functions without bindings.
#ifndef PATINA_LIB_SPLIT_RULE_GLSL
#define PATINA_LIB_SPLIT_RULE_GLSL
#include "shared/segmentation/split_labels.h"

const float kLeastColor = 0.006;  // sum of the channels of a mean; darker ones have no chromaticity to speak of

bool has_chroma(vec3 linear) { return linear.r + linear.g + linear.b >= kLeastColor; }
vec2 chroma_of(vec3 linear) { return linear.rg / max(linear.r + linear.g + linear.b, kLeastColor); }

bool is_beyond(SplitRule rule, vec2 chroma) { return dot(vec2(rule.axis_r, rule.axis_g), chroma) > rule.threshold; }

// Whether a colour is that of the label's partner.
bool is_partners(SplitRule rule, vec3 linear) {
    return has_chroma(linear) && is_beyond(rule, chroma_of(linear)) != (rule.beyond != 0u);
}

#endif
