#pragma once

#include <cstdint>

namespace patina::kinect2 {

/// Base of the decoder's exponentials and logarithms. The sensor's constants, 3.321928 for one, were made for base 2;
/// libfreenect2 computes to base e with them.
enum class Exponentials : uint8_t {
    /// To base e: libfreenect2's depth, which users compare with. Phases may disagree 2.2 times more, within the same
    /// bounds, and neighbours weigh less.
    kAsLibfreenect2,
    kBase2,
};

struct DecodeSettings {
    Exponentials exponentials = Exponentials::kAsLibfreenect2;
    bool smooth_phases =
        true;                ///< over 3 x 3 pixels (add_unwrap_phases); without it, nothing is known of edges in phase
    bool drop_edges = true;  ///< readings between two surfaces (add_undistort_depth)
    float min_m = 0.5f;      ///< nearer readings are dropped
    float max_m = 4.5f;      ///< farther readings are dropped; the sensor's limit is 18.75 m
};

}  // namespace patina::kinect2
