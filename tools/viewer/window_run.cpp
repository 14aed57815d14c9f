#include "tools/viewer/window_run.h"

#include <utility>

#include <fmt/format.h>

#include "reconstruction/session/session_core.h"
#include "tools/program/free_place.h"
#include "tools/program/inputs.h"
#include "tools/report/run_summary.h"
#include "tools/viewer/make_display.h"

namespace patina::tools {

namespace {

/// Beside fusion, drawing takes a tenth of its time at most.
constexpr double kShare = 0.1 / 1.1;
/// How long the user is waited for while the run is paused.
constexpr double kPaused_s = 1.0 / 30;

const char* word_of(TrackingState state) {
    switch (state) {
        case TrackingState::kTracking: return "tracking";
        case TrackingState::kWeak: return "weak";
        case TrackingState::kLost: return "lost";
    }
    return "";
}

double seconds_now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

WindowRun::WindowRun(const ViewerOptions& options, const RunOptions& run, RunCompanion* inner, LiveControls* live)
    : options_(options),
      out_(run.out),
      inner_(inner),
      live_(live),
      display_(make_display(options, "patina", inputs_of(run))) {}

WindowRun::~WindowRun() = default;

void WindowRun::prepare(vulkan::DeviceOptions& options) {
    display_->ask(options);
    if (inner_) inner_->prepare(options);
}

std::unique_ptr<Source> WindowRun::source(vulkan::Device& device) {
    viewer_.emplace(device, *display_, kShare, options_.panels);
    viewer_->state().layer = options_.layer;
    return inner_ ? inner_->source(device) : nullptr;
}

void WindowRun::adjust(SessionCallbacks& callbacks) {
    if (inner_) inner_->adjust(callbacks);
    // A live source is ended instead, and the run is whole then; but for the time before its first frame.
    callbacks.stop = [this, stop = callbacks.stop] { return (closed() && !(live_ && begun_)) || (stop && stop()); };
    callbacks.progress = [this, show = callbacks.progress](const SessionProgress& progress) {
        progress_ = progress.total ? fmt::format("{} of {} {}", progress.done, *progress.total, progress.task)
                                   : fmt::format("{} {}", progress.done, progress.task);
        show(progress);
    };
}

bool WindowRun::closed() {
    if (closed_ || !display_) return closed_;
    display_->poll(0);
    closed_ = display_->closed();
    if (closed_ && live_ && begun_) live_->end_source();
    return closed_;
}

void WindowRun::after_step(SessionCore& session) {
    if (inner_) inner_->after_step(session);
    begun_ = true;
    const Frame* frame = session.fused() ? session.fused() : session.held_out();
    if (frame) {
        sensor_ = *frame->world_from_camera;
        frame_s_ = frame->timestamp_s;
    }
    if (session.fused()) times_.fused(seconds_now(), session.pipeline().runner().pass_timings());
    if (!problem_.empty() || !display_) return;
    if (!frame && display_->wants_all()) return;  // nothing has changed
    bool paused = false;
    do {
        if (paused) session.stop_if_interrupted();
        if (closed() || !show(session, paused)) return;
        // What fails here in the middle leaves no model to go on with.
        if (std::exchange(viewer_->state().undo_asked, false)) undo(session);
        if (std::exchange(paused, viewer_->state().paused) && !paused) viewer_->resume();
        if (paused) times_.paused();
    } while (paused);
    if (session.fused()) keep_checkpoint(session);
}

bool WindowRun::show(SessionCore& session, bool paused) {
    try {
        if (paused) {
            draw(session, kPaused_s);
            session.pipeline().runner().wait();
        } else if (viewer_->due()) {
            draw(session, 0);
        }
        return true;
    } catch (const std::exception& error) {
        // The run needs no window. Of a device that was lost the run finds out itself.
        problem_ = fmt::format("drawing ended: {}", reason_of(error));
        return false;
    }
}

void WindowRun::draw(SessionCore& session, double patience_s) {
    display_->poll(patience_s);
    const Scenery scenery{&session.pipeline(), session.info().depth, sensor_, std::nullopt, session.lighting()};
    viewer_->draw(scenery, facts_of(session));
    take_wishes(session);
}

void WindowRun::take_wishes(SessionCore& session) {
    ViewerState& state = viewer_->state();
    if (std::exchange(state.export_asked, false)) export_now(session);
    if (std::exchange(state.record_asked, false)) record_or_stop();
    if (state.undo_asked && !undo_button(session).can()) {
        message_ = fmt::format("not undone: {}", undo_button(session).lacks);
        state.undo_asked = false;
    }
}

void WindowRun::record_or_stop() {
    const Button button = record_button();
    message_ = button.can() ? live_->toggle_recording() : fmt::format("not recorded: {}", button.lacks);
}

/// Nobody goes back off screen.
void WindowRun::keep_checkpoint(SessionCore& session) {
    const RunMoment now = moment(session);
    const double start_s = seconds_now();
    if (display_->wants_all() || !checkpoint_problem_.empty() || !checkpoints_.due(now, start_s)) return;
    try {
        session.keep_model(checkpoints_.begin());
        const double end_s = seconds_now();
        checkpoints_.kept(now, end_s, end_s - start_s);
    } catch (const std::exception& error) {
        checkpoint_problem_ = fmt::format("no checkpoint could be kept: {}", reason_of(error));
        message_ = checkpoint_problem_;
    }
}

void WindowRun::undo(SessionCore& session) {
    const RunMoment before = moment(session);
    MapFile* map = checkpoints_.choose(before);
    if (!map) return;
    try {
        map->check();
    } catch (const std::exception& error) {
        message_ = fmt::format("not undone: {}", reason_of(error));
        checkpoints_.give_up(before);
        return;
    }
    session.go_back(*map);
    const double lost_s = checkpoints_.went_back(before);
    const uint32_t lost = before.frames - session.pipeline().frames();
    message_ = fmt::format("undone: {} frames of {:.1f} s are forgotten{}", lost, lost_s,
                           session.pipeline().tracking() ? "; show the camera a place from before" : "");
}

Button WindowRun::record_button() const { return {true, live_ ? "" : "only a live source can be recorded"}; }

Button WindowRun::undo_button(SessionCore& session) const {
    if (checkpoints_.can_go_back(moment(session))) return {true, ""};
    if (!checkpoint_problem_.empty()) return {true, checkpoint_problem_};
    return {true, display_->wants_all() ? "off screen no checkpoints are kept"
                                        : "there is no checkpoint before what is shown"};
}

void WindowRun::export_now(SessionCore& session) {
    try {
        const std::filesystem::path folder = free_place_beside(out_, "export");
        session.scene().save(folder);
        message_ = fmt::format("exported to {}", folder.string());
    } catch (const std::exception& error) {
        message_ = fmt::format("not exported: {}", reason_of(error));
    }
}

ViewerFacts WindowRun::facts_of(SessionCore& session) const {
    ViewerFacts facts;
    Pipeline& pipeline = session.pipeline();
    facts.lines.emplace_back("device", session.device().caps().name);
    facts.lines.emplace_back("progress", progress_);
    if (const auto& last = session.last()) {
        facts.lines.emplace_back("camera", last->fused ? word_of(last->state) : "not fused: " + last->reason);
    }
    for (auto& line : figures()) facts.lines.push_back(std::move(line));
    const PipelineCounters counted = pipeline.counters();
    facts.lines.emplace_back("segments", std::to_string(counted.segments.live));
    if (times_.interval_ms() > 0)
        facts.lines.emplace_back(
            "frame", fmt::format("{:.0f} ms, on the device {:.0f} ms", times_.interval_ms(), times_.device_ms()));
    facts.lines.push_back(memory_line(session.device().held_memory()));
    facts.lines.emplace_back("drawn", fmt::format("{} frames, {:.1f} s", viewer_->drawn(), viewer_->spent_s()));
    for (const PoolState& pool : counted.pools)
        facts.pools.push_back({pool.name, pool.used, pool.capacity, pool.refused});
    facts.passes = slowest_passes(pipeline.runner());
    facts.message = message_;
    facts.can_pause = !display_->wants_all();
    facts.record = record_button();
    facts.undo = undo_button(session);
    facts.recording = live_ && live_->is_recording();
    facts.can_export = session.ledger().used() > 0;
    return facts;
}

void WindowRun::end() {
    viewer_.reset();
    try {
        if (display_) display_->finish();
    } catch (const std::exception& error) {
        if (problem_.empty()) problem_ = reason_of(error);
    }
    display_.reset();
    if (inner_) inner_->end();
}

std::vector<std::string> WindowRun::shortfalls() const {
    std::vector<std::string> list = inner_ ? inner_->shortfalls() : std::vector<std::string>();
    if (!problem_.empty()) list.push_back(problem_);
    return list;
}

void WindowRun::add_to(RunSummary& summary) const {
    if (inner_) inner_->add_to(summary);
}

std::vector<std::pair<std::string, std::string>> WindowRun::figures() const {
    return inner_ ? inner_->figures() : std::vector<std::pair<std::string, std::string>>();
}

std::unique_ptr<RunCompanion> show_run(const ViewerOptions& options, const RunOptions& run, RunCompanion* inner,
                                       LiveControls* live) {
    return std::make_unique<WindowRun>(options, run, inner, live);
}

}  // namespace patina::tools
