#pragma once

#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "sensor/live/live_source.h"
#include "sensor/recording/recorder.h"
#include "tools/record/camera_pass.h"

namespace patina::tools {

/// What became of a recording that has ended.
struct EndedRecording {
    std::filesystem::path file;
    sensor::RecorderCounts counts;
    std::string problem, warning;  ///< of Recorder; empty: none
};

/// Records a live source into one file after the other, while it goes on: each has the frames that come between start()
/// and stop(), those that the run drops too. take() is for the camera's thread, all else for the user's.
class LiveRecording {
  public:
    /// `sequence`: what holds for all frames of the source.
    explicit LiveRecording(sensor::RecordedSequence sequence) : sequence_(std::move(sequence)) {}

    /// Begins a file. Throws Error as Recorder does; nothing is recorded then. None may be open.
    void start(const std::filesystem::path& file);

    /// Writes what waits, and closes the file; without an open one nothing happens. A file without frames is removed.
    void stop();

    /// The file that is open.
    std::optional<std::filesystem::path> file() const;
    /// Why nothing more can be written to it; empty while it can, or where none is open.
    std::string problem() const { return recorder_ ? recorder_->problem() : ""; }
    const std::vector<EndedRecording>& ended() const { return ended_; }

    /// What the source yielded; without an open file nothing happens.
    template <class Item>
    void take(const std::variant<Item, Skipped>& reading) {
        if (const auto open = pass()) open->take(reading);
    }

  private:
    std::shared_ptr<CameraPass> pass() const;

    sensor::RecordedSequence sequence_;
    std::shared_ptr<sensor::Recorder> recorder_;  ///< null where no file is open
    std::filesystem::path file_;
    std::vector<EndedRecording> ended_;
    mutable std::mutex mutex_;
    std::shared_ptr<CameraPass> pass_;  ///< of mutex_
};

}  // namespace patina::tools
