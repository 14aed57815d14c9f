#pragma once

#include <cstdint>
#include <functional>

#include "patina/source.h"

namespace patina::sensor {

/// What became of the frames of a live source. captured = delivered + dropped + damaged + those that wait.
struct LiveCounts {
    uint64_t captured = 0;   ///< frames that the camera took, damaged ones included
    uint64_t delivered = 0;  ///< by next()
    uint64_t dropped = 0;    ///< newer frames came before these were asked for; next() yields them as skipped
    uint64_t damaged = 0;
    /// Sent by the camera and never captured, where its driver can tell: a part did not arrive, or came too late.
    uint64_t lost = 0;
};

/// What takes frames by its own clock, whether they are asked for or not, as its user steers it. All functions may be
/// called from any thread.
class LiveCapture {
  public:
    virtual ~LiveCapture() = default;

    /// Ends the source: next() yields what waits, then nothing. May be called more than once.
    virtual void stop() = 0;

    /// Now, on the clock of Frame::timestamp_s, which is that of the exposures.
    virtual double now_s() const = 0;

    virtual LiveCounts counts() const = 0;
};

/// A live capture as a source. The newest frame wins: one that has not been asked for when the next one comes is
/// dropped, and next() yields it as Skipped with `dropped` set. So at most one frame waits, however late the consumer
/// is.
class LiveSource : public Source, public LiveCapture {};

/// Sees every reading of a live source before any is dropped, on the camera's thread; must return before the next one.
using ReadingTap = std::function<void(const Reading&)>;

}  // namespace patina::sensor
