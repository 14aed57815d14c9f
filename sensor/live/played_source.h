#pragma once

#include <memory>
#include <optional>

#include "sensor/live/live_source.h"
#include "sensor/live/player.h"

namespace patina::sensor {

/// A recording that plays as a camera would (Player). Indices and timestamps are the recording's.
class PlayedSource : public LiveSource {
  public:
    /// Begins to play when it is first asked for a reading. `tap` may be empty.
    explicit PlayedSource(std::unique_ptr<Source> recording, ReadingTap tap = {});

    const SequenceInfo& info() const override { return info_; }
    std::optional<Reading> next() override { return player_.next(); }
    /// Once this returns, the tap is not called any more.
    void stop() override { player_.stop(); }
    double now_s() const override { return player_.now_s(); }
    LiveCounts counts() const override { return player_.counts(); }

  private:
    std::unique_ptr<Source> recording_;
    SequenceInfo info_;
    Player<Frame> player_;  // last: its thread reads the recording
};

}  // namespace patina::sensor
