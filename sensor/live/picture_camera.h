#pragma once

#include <functional>
#include <stop_token>

#include "patina/frame.h"

namespace patina::sensor {

/// Where a camera's library leaves its pictures, on the thread of PictureCamera::run(). Times are seconds of one clock
/// for both.
struct PictureSink {
    std::function<void(double timestamp_s, Image<uint16_t> depth)> depth;
    std::function<void(double timestamp_s, Image<SrgbPixel> color)> color;
};

/// A camera as its library has it: depth and colour pictures that come apart.
class PictureCamera {
  public:
    virtual ~PictureCamera() = default;

    /// What holds for all frames; it has no length.
    virtual const SequenceInfo& info() const = 0;

    /// Delivers pictures until it is asked to stop. Throws Error where the camera fails, is unplugged, or sends no
    /// depth for kMostSilence_s.
    virtual void run(const PictureSink& sink, const std::stop_token& stop) = 0;

    static constexpr double kMostSilence_s = 5;
};

}  // namespace patina::sensor
