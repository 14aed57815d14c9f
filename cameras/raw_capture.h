#pragma once

#include <functional>
#include <optional>
#include <string>
#include <variant>

#include "sensor/live/live_source.h"
#include "sensor/recording/recorded_frame.h"

namespace patina::cameras {

/// A frame as a camera sends it, or the reason why there is none at this index.
using RawReading = std::variant<sensor::RecordedFrame, Skipped>;

/// A live capture of frames that are not decoded. The newest frame wins, as in sensor::LiveSource.
class RawCapture : public sensor::LiveCapture {
  public:
    /// Sees every reading before any is dropped, on the capturing thread; must return before the next one.
    using Tap = std::function<void(const RawReading&)>;

    /// What holds for all frames; it has no length.
    virtual const sensor::RecordedSequence& sequence() const = 0;

    /// The camera or the recording, for messages: "Kinect v2 at 2-1".
    virtual const std::string& name() const = 0;

    /// To be called before the first next(). Once stop() has returned, the tap is not called any more.
    virtual void set_tap(Tap tap) = 0;

    /// The next frame, or why there is none; waits for it. Empty after stop(). Frames are taken from the first call on.
    /// Throws Error where the camera or the file fails, after the frames that came before.
    virtual std::optional<RawReading> next() = 0;
};

}  // namespace patina::cameras
