#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "patina/image.h"
#include "tools/eval/result.h"

namespace patina::eval {

/// One object and quantity in one frame, over the object's bounding box. All pictures have one extent.
struct ObjectPictures {
    Image<uint8_t> region;            ///< 1 where truth shows the object; at least one pixel
    Image<uint8_t> filled;            ///< 1 where, inside the region, the run has a value; else 0
    Image<uint8_t> seen;              ///< 1 where, of these, the surface was seen often enough; empty: all were
    std::vector<Image<float>> truth;  ///< per channel; finite inside the region
    std::vector<Image<float>> run;    ///< per channel; finite where filled, anything elsewhere
    bool is_rgb = false;              ///< they are linear colours within [0, 1], and Scores::psnr_srgb_db is wanted
};

/// The scores of one frame. Those of what was seen are left out where it is less than kSmallestRegion.
Comparison compare(const ObjectPictures& pictures);

/// The mean over pixels of each channel, a single channel standing for all three. Empty for an empty mask.
std::optional<glm::dvec3> mean_over(const Image<uint8_t>& mask, std::span<const Image<float>> channels);

/// The mean of each score. Infinite PSNRs count as kPsnrCap_db, as do finite ones above it, unless all are infinite:
/// then so is the mean. At least one element.
Scores mean_of(std::span<const Scores> scores);

/// The mean of each value; `filled` and `seen` over those that have it. At least one element.
Comparison mean_of(std::span<const Comparison> comparisons);

/// The means over the frames of each period. At least one frame, in time.
Averages averages_of(std::span<const FramePoint> frames);

/// The means over objects. At least one.
Averages mean_of(std::span<const Averages> objects);

}  // namespace patina::eval
