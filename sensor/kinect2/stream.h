#pragma once

#include <condition_variable>
#include <cstdint>
#include <exception>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "sensor/kinect2/color_assembler.h"
#include "sensor/kinect2/frame_pairer.h"
#include "sensor/kinect2/frame_queue.h"
#include "sensor/kinect2/infrared_assembler.h"
#include "sensor/kinect2/transport.h"

namespace patina::sensor::kinect2 {

/// What became of both streams since they were started.
struct StreamStatistics {
    InfraredStatistics infrared;
    ColorStatistics color;
    uint64_t transfers = 0;          ///< that the assemblers have worked through
    uint64_t frames = 0;             ///< pairs
    uint64_t unpaired_infrared = 0;  ///< frames without a partner within 16 ms
    uint64_t unpaired_color = 0;
    uint64_t dropped_frames = 0;  ///< pairs that nobody fetched in time
    uint64_t overruns = 0;        ///< transfers lost because the assemblers were late
};

/// One run of the streams: takes transfers from the event thread, and turns them into frames on a thread of its own.
class Stream final : public TransferSink {
  public:
    /// `queued_frames`: how many pairs wait to be fetched. `waiting_transfers`: how many transfers of each kind wait to
    /// be assembled. `name`: the device, for messages.
    Stream(size_t queued_frames, size_t waiting_transfers, std::string name);
    /// The transport must have stopped.
    ~Stream() override;

    void exchange(Transfer& transfer) noexcept override;
    void end(bool unplugged, const std::string& reason) noexcept override;

    FrameQueue& frames() { return frames_; }
    StreamStatistics statistics() const;

  private:
    /// Transfers of one kind that can be given away, and how the last exchange went.
    struct Spares {
        std::vector<Transfer> transfers;
        bool lost_one = false;
    };

    Spares& spares(StreamKind kind) { return kind == StreamKind::kColor ? color_spares_ : infrared_spares_; }
    void run(const std::stop_token& stop);
    bool wait_for_work(const std::stop_token& stop, std::vector<Transfer>& work);
    void assemble(const Transfer& transfer);
    void add_infrared(bool complete, std::span<const uint8_t> packet);
    void add_color(bool complete, std::span<const uint8_t> transfer);
    void hand_out_pairs();
    void give_back(Transfer transfer);
    void publish_statistics();

    FrameQueue frames_;
    std::string name_;

    mutable std::mutex mutex_;
    std::condition_variable_any changed_;
    std::vector<Transfer> filled_;  ///< never more than there are spares
    Spares color_spares_, infrared_spares_;
    std::exception_ptr ending_;  ///< set once no more transfers come
    StreamStatistics statistics_;

    // Of the assembling thread alone.
    InfraredAssembler infrared_;
    ColorAssembler color_;
    FramePairer pairer_;
    RawFrame spare_;
    uint64_t transfers_ = 0, pairs_ = 0;

    std::jthread thread_;  // last: stops and joins before what it uses is destroyed
};

}  // namespace patina::sensor::kinect2
