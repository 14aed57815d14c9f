#pragma once

#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <utility>

#include "engine/core/error.h"
#include "patina/frame.h"

namespace patina::sensor {

/// Joins the pictures of two streams that run freely: a depth picture with the colour picture that is within
/// `most_apart_s` of it, whichever comes first. Each is used once. Colour pictures without depth are left out.
class PicturePairs {
  public:
    using TakePair = std::function<void(double timestamp_s, Image<uint16_t> depth, Image<SrgbPixel> color)>;
    /// A depth picture that has no partner, and why.
    using TakeLost = std::function<void(std::string reason)>;

    PicturePairs(double most_apart_s, TakePair pair, TakeLost lost)
        : most_apart_s_(most_apart_s), pair_(std::move(pair)), lost_(std::move(lost)) {}

    void depth(double timestamp_s, Image<uint16_t> picture) {
        if (depth_) lost_(text("no colour picture came within ", most_apart_s_, " s of the depth picture"));
        depth_.emplace(timestamp_s, std::move(picture));
        join();
    }

    void color(double timestamp_s, Image<SrgbPixel> picture) {
        color_.emplace(timestamp_s, std::move(picture));
        join();
    }

  private:
    void join() {
        if (!depth_ || !color_ || std::abs(depth_->first - color_->first) > most_apart_s_) return;
        pair_(depth_->first, std::move(depth_->second), std::move(color_->second));
        depth_.reset();
        color_.reset();
    }

    double most_apart_s_;
    TakePair pair_;
    TakeLost lost_;
    std::optional<std::pair<double, Image<uint16_t>>> depth_;
    std::optional<std::pair<double, Image<SrgbPixel>>> color_;
};

}  // namespace patina::sensor
