// A voxel's label word: label 16 bits, 0 where none is known | confidence 8 bits. Functions without bindings.
#ifndef PATINA_LIB_VOXEL_LABELS_GLSL
#define PATINA_LIB_VOXEL_LABELS_GLSL
#include "shared/segmentation/segments.h"

uint voxel_label(uint word) { return word & 0xffffu; }
uint label_word(uint label, uint confidence) { return label | confidence << 16; }

// What a voxel holds after a segment with this label has covered it. Agreement strengthens, contradiction weakens, and
// replaces a label without confidence.
uint voted_word(uint word, uint label) {
    const uint confidence = word >> 16;
    if (voxel_label(word) == label) return label_word(label, min(confidence + 1u, kMaxLabelConfidence));
    return confidence > 1u ? label_word(voxel_label(word), confidence - 1u) : label_word(label, 1u);
}

#endif
