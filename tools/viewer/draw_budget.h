#pragma once

#include <cstdint>

#include "patina/image.h"

namespace patina::tools {

/// When a picture may be drawn, so that drawing takes at most a share of the time, and how large it is.
class DrawBudget {
  public:
    /// A picture that takes longer than this is drawn smaller the next time.
    static constexpr double kSlow_s = 0.05;
    static constexpr uint32_t kMostHalvings = 3;

    /// `share`: of all time, above 0 to 1.
    explicit DrawBudget(double share) : share_(share) {}

    /// Whether the pictures so far are paid for at `now_s`, on any clock.
    bool due(double now_s) const { return now_s >= next_s_; }

    /// A picture that was begun at `began_s` took `cost_s`.
    void spend(double began_s, double cost_s);

    /// Nothing waited for the pictures that were drawn until now: they need not be paid for.
    void forgive(double now_s) { next_s_ = now_s; }

    /// A window's picture is drawn at its size, halved so many times.
    Extent2D picture_extent(Extent2D window) const;

  private:
    double share_;
    double next_s_ = 0;
    uint32_t halvings_ = 0;
};

}  // namespace patina::tools
