#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <utility>

#include "tools/eval/result.h"

namespace patina::eval {

/// How many pixels have which pair of object and run label. 0 means none of either: the background, or pixels without
/// truth; and pixels the run does not fill or label.
class LabelOverlap {
  public:
    void add(uint32_t object, uint32_t label, uint64_t pixels) { pixels_[{object, label}] += pixels; }
    void add(const LabelOverlap& other);

    /// How the labels cut up one object, which must have a pixel. Of labels with equal IoU the smallest is the best.
    ObjectSegmentation segmentation_of(uint32_t object) const;

  private:
    /// The pixels of a label, by where they lie.
    struct Label {
        uint64_t inside = 0;   ///< on the object
        uint64_t foreign = 0;  ///< on other objects
        uint64_t total = 0;    ///< those two, and the background
    };
    std::map<uint32_t, Label> labels_on(uint32_t object) const;
    uint64_t pixels_of(uint32_t object) const;

    std::map<std::pair<uint32_t, uint32_t>, uint64_t> pixels_;  ///< by object and label
};

/// The averages over objects, at least one.
SegmentationResult mean_of(std::span<const ObjectSegmentation> objects);

}  // namespace patina::eval
