#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "cameras/kinect2_decoded.h"
#include "patina/device.h"
#include "tools/record/camera_pass.h"
#include "tools/record/decode_queue.h"

namespace patina::tools {

/// Decodes the raw frames of one sequence, or of two of the same camera, on this device, which it keeps.
std::unique_ptr<cameras::Kinect2Repacker> repacker_on(std::shared_ptr<Device> device,
                                                      const sensor::RecordedSequence& raw, const std::string& where);

/// Hands what a raw capture yields to a recorder while a pass of it is recorded: as it is, or decoded on a thread of
/// its own.
class RawPass {
  public:
    explicit RawPass(std::shared_ptr<sensor::Recorder> recorder,
                     std::unique_ptr<cameras::Kinect2Repacker> repacker = nullptr);

    /// Frames that come from now on belong to a sequence that begins.
    void begin(sensor::SequenceRole role, const sensor::RecordedSequence& raw);

    /// For the capture's thread.
    void take(const cameras::RawReading& reading);

    /// Frames that come from now on are left out; waits for those that are being decoded. Returns how many of the pass
    /// were dropped because too many waited to be decoded. Throws Error with problem(), where there is one.
    uint64_t end();

    /// Why nothing more can be decoded; empty while it can.
    std::string problem() const { return queue_ ? queue_->problem() : ""; }

  private:
    CameraPass pass_;
    std::unique_ptr<cameras::Kinect2Repacker> repacker_;
    std::mutex mutex_;
    bool open_ = false;                 ///< of mutex_
    uint64_t dropped_before_ = 0;       ///< by the queue, in earlier passes
    std::optional<DecodeQueue> queue_;  // last: its thread uses what is above
};

}  // namespace patina::tools
