#include "sensor/recording/recorder.h"

#include <algorithm>
#include <cmath>
#include <system_error>
#include <utility>

#include "engine/core/error.h"
#include "sensor/recording/payload_codec.h"

namespace patina::sensor {

namespace {

/// Part of kMostAtRisk_s that is left to the machine's other work.
constexpr double kMargin_s = 0.25;
/// Least time between two commits: each costs the disk a flush.
constexpr double kLeastInterval_s = 0.05;
/// A commit is expected to take as long as the slowest of the last so many.
constexpr size_t kRemembered = 8;
/// A transaction of this size is committed at once. It bounds the memory that it takes.
constexpr uint64_t kMostGathered = uint64_t{64} << 20;
/// The writer waits for a longer log to be brought into the file. This bounds the space that a slow disk needs.
constexpr uint64_t kMostLogBytes = uint64_t{512} << 20;
/// The clock of decoded frames' streams.
constexpr double kSecondsPerTick = 1e-9;

template <class Picture>
uint64_t bytes_of(const Picture& picture) {
    return std::visit([](const auto& image) { return image.pixels().size() * sizeof(image.pixels()[0]); }, picture);
}

// Frames of one sequence may hold pictures of different kinds: each kind is a stream of its own.
enum DecodedStream : uint32_t { kColor8, kColorFloat, kDepthUnits, kDepthMetres };

std::vector<RecordedStream> decoded_streams() {
    std::vector<RecordedStream> streams(4);
    streams[kColor8] = {"color", std::string(kRgb8), kSecondsPerTick};
    streams[kColorFloat] = {"color", std::string(kRgbFloat), kSecondsPerTick};
    streams[kDepthUnits] = {"depth", std::string(kDepth16), kSecondsPerTick};
    streams[kDepthMetres] = {"depth", std::string(kDepthFloat), kSecondsPerTick};
    return streams;
}

int64_t ticks_of(double seconds) { return std::llround(seconds / kSecondsPerTick); }

RecordedFrame packed(const Frame& frame, std::optional<double> arrival_s) {
    RecordedFrame recorded;
    recorded.index = frame.index;
    recorded.timestamp_s = frame.timestamp_s;
    recorded.arrival_s = arrival_s;
    recorded.exposure = frame.exposure;
    recorded.world_from_camera = frame.world_from_camera;
    recorded.pose_defect = frame.pose_defect;
    const int64_t ticks = ticks_of(frame.timestamp_s);
    const bool linear = std::holds_alternative<Image<glm::vec3>>(frame.color);
    const bool metres = std::holds_alternative<Image<float>>(frame.depth);
    recorded.payloads.push_back({linear ? kColorFloat : kColor8, frame.index, ticks, "", encode(frame.color)});
    recorded.payloads.push_back({metres ? kDepthMetres : kDepthUnits, frame.index, ticks, "", encode(frame.depth)});
    return recorded;
}

RecordedFrame without_pictures(uint32_t index, std::string reason) {
    RecordedFrame frame;
    frame.index = index;
    frame.skipped = std::move(reason);
    return frame;
}

}  // namespace

Recorder::Recorder(const std::filesystem::path& file, const Options& options)
    : options_(options), file_(file), writer_(file), thread_([this] { write_all(); }) {}

Recorder::~Recorder() {
    try {
        finish();
    } catch (const std::exception&) {
        // What was committed is there.
    }
}

void Recorder::begin(SequenceRole role, RecordedSequence sequence) {
    if (sequence.streams.empty()) sequence.streams = decoded_streams();
    hand_over({Begin{role, std::move(sequence)}, 0, Clock::now()});
}

void Recorder::record(Frame frame, std::optional<double> arrival_s) {
    const uint64_t bytes = bytes_of(frame.color) + bytes_of(frame.depth);
    hand_over({Decoded{std::move(frame), arrival_s}, bytes, Clock::now()});
}

void Recorder::record(RecordedFrame frame) {
    uint64_t bytes = 0;
    for (const Payload& payload : frame.payloads) bytes += payload.content.size();
    hand_over({std::move(frame), bytes, Clock::now()});
}

void Recorder::skip(Skipped skipped) {
    hand_over({without_pictures(skipped.index, std::move(skipped.reason)), 0, Clock::now(), skipped.dropped});
}

void Recorder::hand_over(Item item) {
    std::unique_lock lock(mutex_);
    const auto fits = [&] {
        return counts_.queued_bytes == 0 || counts_.queued_bytes + item.bytes <= options_.most_queued_bytes ||
               ending_ || !problem_.empty();
    };
    if (options_.when_full == WhenFull::kWait) changed_.wait(lock, fits);
    const bool is_frame = !std::holds_alternative<Begin>(item.content);
    counts_.given += is_frame;
    if (const auto* raw = std::get_if<RecordedFrame>(&item.content); raw && !raw->skipped.empty()) {
        ++counts_.skipped;
        if (!item.dropped) skipped_for_ = raw->skipped;
    }
    if (ending_ || !problem_.empty()) {
        counts_.lost += is_frame;
        return;
    }
    if (!fits()) {
        const auto* decoded = std::get_if<Decoded>(&item.content);
        const uint32_t index = decoded ? decoded->frame.index : std::get<RecordedFrame>(item.content).index;
        item.content = without_pictures(index, "dropped: the disk did not keep pace with the camera");
        item.bytes = 0;
        ++counts_.dropped;
    }
    counts_.queued_bytes += item.bytes;
    counts_.most_queued_bytes = std::max(counts_.most_queued_bytes, counts_.queued_bytes);
    queue_.push_back(std::move(item));
    lock.unlock();
    changed_.notify_all();
}

RecorderCounts Recorder::counts() const {
    const std::lock_guard lock(mutex_);
    return counts_;
}

std::string Recorder::skipped_for() const {
    const std::lock_guard lock(mutex_);
    return skipped_for_;
}

std::string Recorder::problem() const {
    const std::lock_guard lock(mutex_);
    return problem_;
}

std::string Recorder::warning() const {
    const std::lock_guard lock(mutex_);
    return warning_;
}

void Recorder::finish() {
    {
        const std::lock_guard lock(mutex_);
        ending_ = true;
    }
    changed_.notify_all();
    if (thread_.joinable()) thread_.join();
    if (const std::string why = problem(); !why.empty()) throw Error(why);
}

void Recorder::discard() noexcept {
    try {
        finish();
    } catch (const std::exception&) {  // it is removed all the same
    }
    for (const char* end : {"", "-wal", "-shm"}) {
        std::error_code ignored;
        std::filesystem::remove(file_.string() + end, ignored);
    }
}

void Recorder::write_all() {
    try {
        keeper_.emplace(file_);
        while (std::optional<Item> item = take()) gather(*item);
        commit();
        keeper_.reset();
        writer_.finish();
    } catch (const std::exception& error) {
        fail(text("the recording could not be completed, what was written before is kept: ", reason_of(error)));
    }
}

/// The next item; while there is none, commits when that is due. Empty at the end.
std::optional<Recorder::Item> Recorder::take() {
    std::unique_lock lock(mutex_);
    while (true) {
        const auto ready = [&] { return !queue_.empty() || ending_; };
        if (!gathered_.empty()) {
            if (commit_is_due() || !changed_.wait_until(lock, commit_due(), ready)) {
                lock.unlock();
                commit();
                lock.lock();
                continue;
            }
        } else {
            changed_.wait(lock, ready);
        }
        if (queue_.empty()) return std::nullopt;
        Item item = std::move(queue_.front());
        queue_.pop_front();
        return item;
    }
}

void Recorder::gather(Item& item) {
    if (const auto* begin = std::get_if<Begin>(&item.content)) {
        commit();
        role_ = begin->role;
        writer_.begin(role_, begin->sequence);
    } else if (const auto* decoded = std::get_if<Decoded>(&item.content)) {
        gather_frame(packed(decoded->frame, decoded->arrival_s), item);
    } else {
        gather_frame(std::get<RecordedFrame>(std::move(item.content)), item);
    }
}

void Recorder::gather_frame(RecordedFrame frame, const Item& item) {
    if (gathered_.empty()) {
        oldest_ = item.given;
        began_ = Clock::now();
    }
    gathered_.push_back(std::move(frame));
    gathered_bytes_ += item.bytes;
}

/// Early where the queue fills up.
bool Recorder::commit_is_due() const {
    return gathered_bytes_ >= std::min(kMostGathered, options_.most_queued_bytes / 2) || Clock::now() >= commit_due();
}

Recorder::Clock::time_point Recorder::commit_due() const {
    const auto after = [](Clock::time_point start, double seconds) {
        return start + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
    };
    const double expected_s = commits_s_.empty() ? kMargin_s : *std::ranges::max_element(commits_s_);
    // A recorder that is late must not spend its time on commits.
    const auto earliest = after(began_, std::max(kLeastInterval_s, expected_s));
    return std::max(earliest, after(oldest_, kMostAtRisk_s - kMargin_s - expected_s));
}

/// Writes all frames at once: a transaction that stays open keeps the log from beginning anew.
void Recorder::commit() {
    if (gathered_.empty()) return;
    const auto start = Clock::now();
    uint64_t bytes = 0;
    for (const RecordedFrame& frame : gathered_) {
        writer_.add(role_, frame);
        for (const Payload& payload : frame.payloads) bytes += payload.content.size();
    }
    writer_.commit();
    const double took_s = std::chrono::duration<double>(Clock::now() - start).count();
    commits_s_.push_back(took_s);
    if (commits_s_.size() > kRemembered) commits_s_.pop_front();
    {
        const std::lock_guard lock(mutex_);
        counts_.written += gathered_.size();
        counts_.bytes += bytes;
        counts_.queued_bytes -= gathered_bytes_;
        counts_.slowest_commit_s = std::max(counts_.slowest_commit_s, took_s);
    }
    changed_.notify_all();
    gathered_.clear();
    gathered_bytes_ = 0;
    keeper_->committed(kMostLogBytes);
    if (const std::string why = keeper_->problem(); !why.empty()) {
        const std::lock_guard lock(mutex_);
        warning_ = "while it was written, a cut of the power could have cost more than a second: " + why;
    }
}

void Recorder::fail(const std::string& problem) {
    {
        const std::lock_guard lock(mutex_);
        problem_ = problem;
        counts_.lost += gathered_.size();
        for (const Item& item : queue_) counts_.lost += !std::holds_alternative<Begin>(item.content);
        queue_.clear();
        counts_.queued_bytes = 0;
    }
    changed_.notify_all();
}

std::function<void(const Reading&)> tap_to(std::shared_ptr<Recorder> recorder) {
    if (!recorder) return {};
    return [recorder = std::move(recorder)](const Reading& reading) {
        if (const auto* skipped = std::get_if<Skipped>(&reading)) return recorder->skip(*skipped);
        recorder->record(std::get<Frame>(reading));
    };
}

}  // namespace patina::sensor
