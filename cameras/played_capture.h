#pragma once

#include <filesystem>
#include <string>

#include "cameras/raw_capture.h"
#include "sensor/live/player.h"
#include "sensor/recording/container.h"

namespace patina::cameras {

/// The raw frames of a recording in one file, played as their camera sent them (sensor::Player). Indices and timestamps
/// are the recording's; nothing is decoded.
class PlayedCapture : public RawCapture {
  public:
    /// Begins to play when it is first asked for a frame. Throws Error where there is no such sequence, or it holds no
    /// frame.
    PlayedCapture(const std::filesystem::path& file, sensor::SequenceRole role);

    const sensor::RecordedSequence& sequence() const override { return sequence_; }
    const std::string& name() const override { return name_; }
    void set_tap(Tap tap) override { player_.set_tap(std::move(tap)); }
    std::optional<RawReading> next() override { return player_.next(); }
    void stop() override { player_.stop(); }
    double now_s() const override { return player_.now_s(); }
    sensor::LiveCounts counts() const override { return player_.counts(); }

  private:
    std::optional<RawReading> read();

    sensor::RecordingFile file_;
    sensor::SequenceRole role_;
    sensor::RecordedSequence sequence_;
    std::string name_;
    uint32_t frames_, next_ = 0;
    sensor::Player<sensor::RecordedFrame> player_;  // last: its thread reads the file
};

}  // namespace patina::cameras
