// A voxel's label word: label 16 bits, 0 where none is known | confidence 6 bits | tag 10 bits, zero between frames.
// Functions without bindings.
#ifndef PATINA_LIB_VOXEL_LABELS_GLSL
#define PATINA_LIB_VOXEL_LABELS_GLSL
#include "shared/segments.h"

const uint kTagShift = 22u;

uint voxel_label(uint word) { return word & 0xffffu; }
uint label_confidence(uint word) { return word >> 16 & kMaxLabelConfidence; }
uint label_word(uint label, uint confidence) { return label | confidence << 16; }

// What tells the pixels apart that see one voxel, in a window of 32 x 31 pixels; never 0.
uint pixel_tag(uvec2 pixel) { return 1u + (pixel.x & 31u) + 32u * (pixel.y % 31u); }
uint word_tag(uint word) { return word >> kTagShift; }
uint tagged(uint word, uint tag) { return (word & ((1u << kTagShift) - 1u)) | tag << kTagShift; }

// What a voxel holds after a segment with this label has covered it. Agreement strengthens, contradiction weakens, and
// replaces a label without confidence.
uint voted_word(uint word, uint label) {
    const uint known = voxel_label(word), confidence = label_confidence(word);
    if (known == label) return label_word(label, min(confidence + 1u, kMaxLabelConfidence));
    return confidence > 1u ? label_word(known, confidence - 1u) : label_word(label, 1u);
}

#endif
