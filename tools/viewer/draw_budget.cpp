#include "tools/viewer/draw_budget.h"

#include <algorithm>

namespace patina::tools {

void DrawBudget::spend(double began_s, double cost_s) {
    next_s_ = std::max(next_s_, began_s) + cost_s / share_;
    // Half the size takes a quarter of the time or more; so a picture that grows again is not slow at once.
    if (cost_s > kSlow_s && halvings_ < kMostHalvings)
        ++halvings_;
    else if (cost_s < kSlow_s / 6 && halvings_ > 0)
        --halvings_;
}

Extent2D DrawBudget::picture_extent(Extent2D window) const {
    return {std::max(1u, window.width >> halvings_), std::max(1u, window.height >> halvings_)};
}

}  // namespace patina::tools
