#pragma once

#include <cstdint>

#include "patina/image.h"

namespace patina::reference {

/// Structural similarity of one channel over the pixels where `mask` is 1, straight from its definition: per pixel the
/// full 11 x 11 Gaussian of sigma 1.5, restricted to the mask and scaled to sum 1, deviations from the window's means
/// taken in a second sweep; K1 0.01, K2 0.03, range 1.
double ssim(const Image<float>& x, const Image<float>& y, const Image<uint8_t>& mask);

}  // namespace patina::reference
