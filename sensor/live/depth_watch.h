#pragma once

#include <chrono>

#include "engine/core/error.h"
#include "sensor/live/picture_camera.h"

namespace patina::sensor {

/// Notices that a camera sends no depth any more. Without depth there are no frames, and who waits for one would wait
/// without end, though colour goes on.
class DepthWatch {
  public:
    using Clock = std::chrono::steady_clock;

    explicit DepthWatch(Clock::time_point now = Clock::now()) : last_(now) {}

    void heard(Clock::time_point now = Clock::now()) { last_ = now; }

    /// Throws Error where no depth picture came for PictureCamera::kMostSilence_s. `camera`: as a sentence begins.
    void expect(const char* camera, Clock::time_point now = Clock::now()) const {
        const std::chrono::duration<double> silence = now - last_;
        if (silence.count() > PictureCamera::kMostSilence_s)
            throw Error(camera, " has sent no depth pictures for ", PictureCamera::kMostSilence_s,
                        " s: it was unplugged, perhaps");
    }

  private:
    Clock::time_point last_;
};

}  // namespace patina::sensor
