#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "patina/image.h"

namespace patina::eval {

/// The structural similarity of one object's pictures, over the filled pixels and over all.
struct SsimScores {
    std::optional<double> filled;  ///< over the filled pixels; empty where there is none
    double all = 0;                ///< over the region, unfilled pixels of `run` being 0
};

/// Structural similarity (Wang et al., Image Quality Assessment: From Error Visibility to Structural Similarity, IEEE
/// TIP 2004): 11 x 11 Gaussian window of sigma 1.5, K1 0.01, K2 0.03, range 1; the mean over the pixels of a mask and
/// over the channels. Of a window only the pixels inside the mask count, their weights scaled to sum 1. All pictures
/// have one extent; `region` and `filled` hold 1 and 0, `filled` only inside a region of at least one pixel. Values
/// outside the masks are not used and may be anything.
SsimScores ssim(std::span<const Image<float>> truth, std::span<const Image<float>> run, const Image<uint8_t>& region,
                const Image<uint8_t>& filled);

}  // namespace patina::eval
