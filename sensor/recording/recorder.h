#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <variant>
#include <vector>

#include "sensor/recording/container.h"
#include "sensor/recording/log_keeper.h"
#include "sensor/recording/recorded_frame.h"

namespace patina::sensor {

/// What a recorder has done so far.
struct RecorderCounts {
    uint64_t given = 0;    ///< frames and skipped ones that it was handed
    uint64_t written = 0;  ///< of these, on the disk
    uint64_t dropped = 0;  ///< frames that came while the queue was full; they are in the file as skipped
    uint64_t lost = 0;     ///< those that came when nothing more could be written, and those since the last commit then
    uint64_t bytes = 0;    ///< of payloads on the disk
    uint64_t queued_bytes = 0, most_queued_bytes = 0;  ///< of frames that are not committed; and at the most
    double slowest_commit_s = 0;
};

/// Writes frames to a recording on a thread of its own, which also compresses them. It commits in time for what a kill
/// would cost never to be older than kMostAtRisk_s; that begins with the moment in which a frame is handed over.
/// Another thread brings commits to the disk at once, for the power may be cut. Frames are handed over from one thread
/// at a time.
class Recorder {
  public:
    static constexpr double kMostAtRisk_s = 0.5;

    /// What becomes of a frame that finds the queue full.
    enum class WhenFull {
        kDrop,  ///< it is noted as skipped: a camera does not wait
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

    /// What comes from now on belongs to this sequence. One of decoded frames has no streams of its own.
    void begin(SequenceRole role, RecordedSequence sequence);

    /// Takes the next frame: decoded, or as it came; or notes why there is none. Frames' indices count from 0.
    void record(Frame frame, std::optional<double> arrival_s = std::nullopt);
    void record(RecordedFrame frame);
    void skip(Skipped skipped);

    RecorderCounts counts() const;

    /// Why nothing more can be written, in one sentence; empty while it can.
    std::string problem() const;

    /// Writes what waits, and ends the recording. Throws Error with problem() where there is one; what was committed
    /// before is there.
    void finish();

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
    std::string problem_;

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

}  // namespace patina::sensor
