#pragma once

#include <memory>

#include "patina/source.h"

namespace patina::sensor {

/// Another source's frames at other sizes, with intrinsics to match. Depth takes the nearest pixel, so that no reading
/// is invented across edges; colour is averaged over the covered area where it shrinks, and interpolated linearly
/// otherwise.
class ResampledSource : public Source {
  public:
    ResampledSource(std::unique_ptr<Source> source, Extent2D color_extent, Extent2D depth_extent);

    const SequenceInfo& info() const override { return info_; }
    std::optional<Reading> next() override;

  private:
    std::unique_ptr<Source> source_;
    SequenceInfo info_;
};

}  // namespace patina::sensor
