#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <utility>
#include <variant>

#include "sensor/recording/recorder.h"

namespace patina::tools {

/// Hands a camera's frames to a recorder while a pass of it is recorded. Both functions may be called from any thread.
class CameraPass {
  public:
    explicit CameraPass(std::shared_ptr<sensor::Recorder> recorder) : recorder_(std::move(recorder)) {}

    /// Frames that come from now on belong to a sequence that begins; their indices count from 0.
    void begin(sensor::SequenceRole role, sensor::RecordedSequence sequence) {
        const std::lock_guard lock(mutex_);
        recorder_->begin(role, std::move(sequence));
        frames_ = 0;
        open_ = true;
    }

    /// Frames that come from now on are left out.
    void end() {
        const std::lock_guard lock(mutex_);
        open_ = false;
    }

    /// A frame, decoded or not, or why there is none.
    template <class Item>
    void take(std::variant<Item, Skipped> reading) {
        const std::lock_guard lock(mutex_);
        if (!open_) return;
        if (auto* skipped = std::get_if<Skipped>(&reading)) {
            recorder_->skip({frames_++, std::move(skipped->reason), skipped->dropped});
        } else {
            Item frame = std::get<Item>(std::move(reading));
            frame.index = frames_++;
            recorder_->record(std::move(frame));
        }
    }

  private:
    std::shared_ptr<sensor::Recorder> recorder_;
    std::mutex mutex_;
    uint32_t frames_ = 0;  ///< of the pass
    bool open_ = false;
};

}  // namespace patina::tools
