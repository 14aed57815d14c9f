#pragma once

#include <atomic>
#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tools/viewer/checkpoints.h"
#include "tools/viewer/frame_times.h"
#include "tools/viewer/viewer.h"
#include "tools/viewer/viewer_options.h"

namespace patina::tools {

/// Shows a run's scene while it grows, beside whoever else goes along.
class WindowRun : public RunCompanion {
  public:
    /// As show_run().
    WindowRun(const ViewerOptions& options, const RunOptions& run, RunCompanion* inner, LiveControls* live);
    ~WindowRun() override;

    void prepare(vulkan::DeviceOptions& options) override;
    std::unique_ptr<Source> source(vulkan::Device& device) override;
    void adjust(SessionCallbacks& callbacks) override;
    void after_step(SessionCore& session) override;
    void end() override;
    std::vector<std::string> shortfalls() const override;
    void add_to(RunSummary& summary) const override;
    std::vector<std::pair<std::string, std::string>> figures() const override;

  private:
    /// Draws, where there is time; `paused`: in any case, and waits for the user. False where that failed.
    bool show(SessionCore& session, bool paused);
    void draw(SessionCore& session, double patience_s);
    void take_wishes(SessionCore& session);
    void record_or_stop();
    void keep_checkpoint(SessionCore& session);
    void undo(SessionCore& session);
    Button record_button() const;
    Button undo_button(SessionCore& session) const;
    RunMoment moment(SessionCore& session) const { return {frame_s_, session.pipeline().frames()}; }
    void export_now(SessionCore& session);
    ViewerFacts facts_of(SessionCore& session) const;
    /// Whether the user has closed the window, and wants the run to end.
    bool closed();

    ViewerOptions options_;
    std::filesystem::path out_;
    RunCompanion* inner_;
    LiveControls* live_;                ///< null where the source is not live
    std::unique_ptr<Display> display_;  ///< null once the run has ended
    std::optional<Viewer> viewer_;      ///< from the device on
    std::optional<RigidTransform> sensor_;
    Checkpoints checkpoints_;
    FrameTimes times_;
    double frame_s_ = 0;  ///< timestamp of the last frame that was fused or held out
    std::string checkpoint_problem_;
    std::string progress_, message_, problem_;
    bool begun_ = false, closed_ = false;
};

}  // namespace patina::tools
