#pragma once

#include "passes/input/filter_depth.h"
#include "patina/image.h"

namespace patina::reference {

/// What add_filter_depth computes: Tomasi and Manduchi's bilateral filter over 5 x 5 pixels.
Image<float> filter_depth(const Image<float>& depth_m, const DepthFilter& filter);

}  // namespace patina::reference
