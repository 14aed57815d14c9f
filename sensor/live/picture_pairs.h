#pragma once

#include <cmath>
#include <cstddef>
#include <deque>
#include <functional>
#include <string>
#include <utility>

#include "engine/core/error.h"
#include "patina/frame.h"

namespace patina::sensor {

/// Joins the pictures of two streams that run freely: a depth picture with the nearest colour picture so far, where
/// that is within `most_apart_s` of it. Each is used once. Times of one stream rise. One stream may come late by
/// kMostWaiting pictures, as a slow decoder or a busy machine makes it. Colour pictures without depth are left out.
class PicturePairs {
  public:
    /// Half a second at 30 a second.
    static constexpr size_t kMostWaiting = 15;

    using TakePair = std::function<void(double timestamp_s, Image<uint16_t> depth, Image<SrgbPixel> color)>;
    /// A depth picture that has no partner, and why.
    using TakeLost = std::function<void(std::string reason)>;

    PicturePairs(double most_apart_s, TakePair pair, TakeLost lost)
        : most_apart_s_(most_apart_s), pair_(std::move(pair)), lost_(std::move(lost)) {}

    void depth(double timestamp_s, Image<uint16_t> picture) {
        depth_.push_back({timestamp_s, std::move(picture)});
        join();
        if (depth_.size() > kMostWaiting) lose_depth();
    }

    void color(double timestamp_s, Image<SrgbPixel> picture) {
        color_.push_back({timestamp_s, std::move(picture)});
        join();
        if (color_.size() > kMostWaiting) color_.pop_front();
    }

  private:
    template <class Pixel>
    struct Picture {
        double timestamp_s;
        Image<Pixel> image;
    };

    void join() {
        while (!depth_.empty() && !color_.empty()) {
            const double depth_s = depth_.front().timestamp_s, color_s = color_.front().timestamp_s;
            const double apart_s = std::abs(depth_s - color_s);
            const bool nearer_depth = depth_.size() > 1 && std::abs(depth_[1].timestamp_s - color_s) < apart_s;
            const bool nearer_color = color_.size() > 1 && std::abs(color_[1].timestamp_s - depth_s) < apart_s;
            if (apart_s <= most_apart_s_ && !nearer_depth && !nearer_color) {
                Picture<uint16_t> depth = std::move(depth_.front());
                Picture<SrgbPixel> color = std::move(color_.front());
                depth_.pop_front();
                color_.pop_front();
                pair_(depth_s, std::move(depth.image), std::move(color.image));
            } else if (depth_s > color_s) {
                color_.pop_front();
            } else {
                lose_depth();
            }
        }
    }

    void lose_depth() {
        depth_.pop_front();
        lost_(text("no colour picture came within ", most_apart_s_, " s of the depth picture"));
    }

    double most_apart_s_;
    TakePair pair_;
    TakeLost lost_;
    std::deque<Picture<uint16_t>> depth_;
    std::deque<Picture<SrgbPixel>> color_;
};

}  // namespace patina::sensor
