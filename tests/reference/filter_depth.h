#pragma once

#include "engine/core/image.h"
#include "passes/input/filter_depth.h"

namespace patina::reference {

/// What add_filter_depth computes: Tomasi and Manduchi's bilateral filter over 5 x 5 pixels.
Image<float> filter_depth(const Image<float>& depth_m, const DepthFilter& filter);

}  // namespace patina::reference
