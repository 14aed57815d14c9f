#include "tools/live/live_run.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "tools/program/free_place.h"
#include "tools/report/live_summary.h"

namespace patina::tools {

namespace {

/// So many latest frames are what the line of progress tells of.
constexpr size_t kShown = 100;
/// Pictures are rendered at a half of the depth camera's size: a person looks at them while the room is recorded.
constexpr uint32_t kPictureShare = 2;

/// A source that others hold as well.
class SharedSource : public Source {
  public:
    explicit SharedSource(std::shared_ptr<Source> source) : source_(std::move(source)) {}
    const SequenceInfo& info() const override { return source_->info(); }
    std::optional<Reading> next() override { return source_->next(); }

  private:
    std::shared_ptr<Source> source_;
};

LatencySummary latest(const std::vector<float>& latencies_s) {
    const size_t count = std::min(latencies_s.size(), kShown);
    return summarised({latencies_s.end() - static_cast<ptrdiff_t>(count), latencies_s.end()});
}

}  // namespace

LiveInput live_input(std::shared_ptr<sensor::LiveSource> source) {
    return {source, [source](vulkan::Device&) { return std::make_unique<SharedSource>(source); }};
}

LiveRun::LiveRun(LiveInput input, std::shared_ptr<LiveRecording> recording, std::filesystem::path out, double seconds)
    : input_(std::move(input)), recording_(std::move(recording)), out_(std::move(out)), seconds_(seconds) {}

LiveRun::~LiveRun() { end(); }

std::unique_ptr<Source> LiveRun::source(vulkan::Device& device) { return input_.open(device); }

void LiveRun::adjust(SessionCallbacks& callbacks) {
    // Before the first frame an interrupt stops the search for lights; later it ends the source, and the run is whole.
    callbacks.stop = [this] { return interrupt_.requested() && !begun_; };
    callbacks.progress = [this, show = callbacks.progress](SessionProgress progress) {
        if (begun_) progress.detail = detail() + "  " + progress.detail;
        show(progress);
    };
}

void LiveRun::after_step(SessionCore& session) {
    const double now_s = input_.capture->now_s();
    if (!begun_.exchange(true)) watch_.emplace(*input_.capture, interrupt_, seconds_);
    const Frame* frame = session.fused();
    if (!first_s_) first_s_ = frame ? frame->timestamp_s : now_s;
    last_s_ = now_s;
    if (frame) to_pose_s_.push_back(static_cast<float>(now_s - frame->timestamp_s));
    look(session);
}

/// One picture is on its way at a time, so that a device that is slow renders fewer.
void LiveRun::look(SessionCore& session) {
    if (picture_ && picture_->view.ready()) {
        to_picture_s_.push_back(static_cast<float>(input_.capture->now_s() - picture_->exposed_s));
        picture_.reset();
    }
    const Frame* frame = session.fused();
    if (picture_ || !frame) return;
    const Intrinsics& camera = session.info().depth;
    const Extent2D extent{std::max(1u, camera.extent.width / kPictureShare),
                          std::max(1u, camera.extent.height / kPictureShare)};
    picture_.emplace(
        Picture{session.pipeline().view(scaled_to(camera, extent), *frame->world_from_camera), frame->timestamp_s});
}

void LiveRun::end() {
    if (std::exchange(ended_, true)) return;
    watch_.reset();
    input_.capture->stop();
    counts_ = input_.capture->counts();
    picture_.reset();
    recording_->stop();
}

std::string LiveRun::toggle_recording() {
    if (recording_->file()) {
        recording_->stop();
        const EndedRecording& ended = recording_->ended().back();
        if (!ended.problem.empty()) return ended.problem;
        if (ended.counts.given == 0) return "no frame came: nothing was recorded";
        return fmt::format("{} frames in {}", ended.counts.written, ended.file.string());
    }
    try {
        recording_->start(free_place_beside(out_, "recording", ".patina"));
    } catch (const std::exception& error) {
        return fmt::format("not recorded: {}", reason_of(error));
    }
    return fmt::format("recording to {}", recording_->file()->string());
}

std::vector<std::string> LiveRun::shortfalls() const {
    std::vector<std::string> list;
    for (const EndedRecording& ended : recording_->ended()) {
        if (!ended.problem.empty()) list.push_back(ended.problem);
        if (ended.counts.dropped > 0)
            list.push_back(fmt::format("{} of {} frames are missing in '{}': the disk did not keep pace",
                                       ended.counts.dropped, ended.counts.given, ended.file.string()));
    }
    return list;
}

std::string LiveRun::detail() const {
    const sensor::LiveCounts counts = input_.capture->counts();
    const LatencySummary pose = latest(to_pose_s_), picture = latest(to_picture_s_);
    const std::string lost = counts.lost > 0 ? fmt::format(", {} lost", counts.lost) : "";
    return fmt::format("{} captured, {} dropped{}  pose {:.0f}/{:.0f} ms, picture {:.0f}/{:.0f} ms (median/95 %)",
                       counts.captured, counts.dropped, lost, pose.median_ms, pose.p95_ms, picture.median_ms,
                       picture.p95_ms);
}

std::vector<std::pair<std::string, std::string>> LiveRun::figures() const {
    const sensor::LiveCounts counts = input_.capture->counts();
    const LatencySummary pose = latest(to_pose_s_), picture = latest(to_picture_s_);
    std::vector<std::pair<std::string, std::string>> lines{
        {"captured", std::to_string(counts.captured)},
        {"dropped", std::to_string(counts.dropped)},
        {"pose after", fmt::format("{:.0f} ms, 95 %: {:.0f} ms", pose.median_ms, pose.p95_ms)},
        {"picture after", fmt::format("{:.0f} ms, 95 %: {:.0f} ms", picture.median_ms, picture.p95_ms)}};
    if (counts.lost > 0) lines.emplace_back("lost on the way", std::to_string(counts.lost));
    if (const auto file = recording_->file()) {
        const std::string problem = recording_->problem();
        lines.emplace_back("recording", problem.empty() ? file->string() : problem);
    }
    return lines;
}

void LiveRun::add_to(RunSummary& summary) const {
    LiveSummary live;
    live.captured = counts_.captured;
    live.dropped = counts_.dropped;
    live.damaged = counts_.damaged;
    live.lost = counts_.lost;
    live.seconds = last_s_ - first_s_.value_or(last_s_);
    live.pose = summarised(to_pose_s_);
    live.picture = summarised(to_picture_s_);
    for (const EndedRecording& ended : recording_->ended()) {
        const sensor::RecorderCounts& counts = ended.counts;
        if (counts.given > 0)
            live.recordings.push_back(
                {ended.file.string(), counts.given, counts.dropped, counts.bytes, counts.most_queued_bytes});
        if (!ended.warning.empty()) summary.warnings.push_back(ended.warning);
    }
    summary.live = std::move(live);
}

}  // namespace patina::tools
