#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <variant>
#include <vector>

#include "patina/source.h"
#include "sensor/recording/container.h"
#include "sensor/recording/log_keeper.h"
#include "sensor/recording/recorded_frame.h"

namespace patina::sensor {

/// What a recorder has done so far.
struct RecorderCounts {
    uint64_t given = 0;         ///< frames that were handed over, skipped ones included; written + lost at the end
    uint64_t written = 0;       ///< of these, committed
    uint64_t skipped = 0;       ///< frames that were handed over without pictures
    uint64_t dropped = 0;       ///< frames that found the queue full; the file has them as skipped
    uint64_t lost = 0;          ///< not in the file: it could not be written, or the recording had ended
    uint64_t bytes = 0;         ///< of committed payloads
    uint64_t queued_bytes = 0;  ///< of frames that are not committed
    uint64_t most_queued_bytes = 0;
    double slowest_commit_s = 0;
};

/// Writes frames to a recording. A thread of its own compresses and commits them: a frame is committed within
/// kMostAtRisk_s of being handed over, so that a kill costs no more. A second thread brings each commit to the disk at
/// once, so that a cut of the power costs little more. Frames are handed over from one thread at a time.
class Recorder {
  public:
    static constexpr double kMostAtRisk_s = 0.5;

    /// What becomes of a frame that finds the queue full.
    enum class WhenFull {
        kDrop,  ///< the file has it as skipped; for cameras, which do not wait
        kWait   ///< the caller waits
    };

    struct Options {
        WhenFull when_full = WhenFull::kDrop;
        uint64_t most_queued_bytes = uint64_t{512} << 20;  ///< five seconds of raw frames of a Kinect v2
    };

    /// Creates the file. Throws Error as RecordingWriter does.
    explicit Recorder(const std::filesystem::path& file) : Recorder(file, Options{}) {}
    Recorder(const std::filesystem::path& file, const Options& options);
    /// Writes what waits, like finish(), but reports no failure.
    ~Recorder();
    Recorder(const Recorder&) = delete;
    Recorder& operator=(const Recorder&) = delete;

    /// Begins a sequence: the frames that follow belong to it. A sequence without streams gets those of decoded frames.
    void begin(SequenceRole role, RecordedSequence sequence);

    /// Adds the next frame: decoded, or as a device sent it, or the reason why there is none. Indices count from 0 in
    /// each sequence. After finish() a frame is lost, and counted.
    void record(Frame frame, std::optional<double> arrival_s = std::nullopt);
    void record(RecordedFrame frame);
    void skip(Skipped skipped);

    RecorderCounts counts() const;

    /// Why nothing more can be written, in one sentence; empty while it can.
    std::string problem() const;

    /// Why a cut of the power could have cost more than it should, in one sentence; empty where it could not.
    std::string warning() const;

    /// Why the last frame that was handed over without pictures has none; those that were dropped do not count.
    std::string skipped_for() const;

    /// Writes what waits, and ends the recording. Throws Error with problem() where there is one; the file then keeps
    /// what was committed.
    void finish();

    /// Ends the recording and removes its file, where nothing of it is worth keeping.
    void discard() noexcept;

  private:
    using Clock = std::chrono::steady_clock;
    struct Begin {
        SequenceRole role;
        RecordedSequence sequence;
    };
    struct Decoded {
        Frame frame;
        std::optional<double> arrival_s;
    };
    struct Item {
        std::variant<Begin, Decoded, RecordedFrame> content;
        uint64_t bytes = 0;
        Clock::time_point given{};
        bool dropped = false;  ///< skipped, and nothing was wrong with it
    };

    void hand_over(Item item);
    void write_all();
    std::optional<Item> take();
    void gather(Item& item);
    void gather_frame(RecordedFrame frame, const Item& item);
    bool commit_is_due() const;
    void commit();
    void fail(const std::string& problem);
    Clock::time_point commit_due() const;

    Options options_;
    std::filesystem::path file_;

    mutable std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<Item> queue_;
    bool ending_ = false;
    RecorderCounts counts_;
    std::string problem_, warning_, skipped_for_;

    // Of the writing thread alone.
    RecordingWriter writer_;
    SequenceRole role_ = SequenceRole::kMain;
    std::optional<LogKeeper> keeper_;
    std::vector<RecordedFrame> gathered_;   ///< of the next transaction
    uint64_t gathered_bytes_ = 0;           ///< as they count in the queue, which they leave with the commit
    Clock::time_point oldest_{}, began_{};  ///< of these: handed over, and gathered
    std::deque<double> commits_s_;

    std::thread thread_;
};

/// Hands every reading to a recorder; empty where there is none.
std::function<void(const Reading&)> tap_to(std::shared_ptr<Recorder> recorder);

}  // namespace patina::sensor
