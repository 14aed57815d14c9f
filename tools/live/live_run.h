#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "reconstruction/view_readback.h"
#include "sensor/live/live_source.h"
#include "tools/live/live_controls.h"
#include "tools/live/live_recording.h"
#include "tools/program/camera_watch.h"
#include "tools/program/interrupt.h"
#include "tools/run/run.h"

namespace patina::tools {

/// What a live run reads: what its user steers, and how the device's thread reads the frames.
struct LiveInput {
    std::shared_ptr<sensor::LiveCapture> capture;
    /// Opens the source; called once. The device outlives the source, but not the capture.
    std::function<std::unique_ptr<Source>(vulkan::Device&)> open;
};

/// A source that needs no device.
LiveInput live_input(std::shared_ptr<sensor::LiveSource> source);

/// Goes along with a live run: measures how long after its exposure a frame's pose and a picture of the model are
/// there, ends the source when the user asks or the time is over, records it, and reports what was dropped.
class LiveRun : public RunCompanion, public LiveControls {
  public:
    /// `recording` takes what the source yields. `out`: the run's folder; recordings that the user begins lie beside
    /// it. `seconds`: of the source; 0: no limit.
    LiveRun(LiveInput input, std::shared_ptr<LiveRecording> recording, std::filesystem::path out, double seconds);
    ~LiveRun() override;

    std::unique_ptr<Source> source(vulkan::Device& device) override;
    void adjust(SessionCallbacks& callbacks) override;
    void after_step(SessionCore& session) override;
    void end() override;
    std::vector<std::string> shortfalls() const override;
    void add_to(RunSummary& summary) const override;
    std::vector<std::pair<std::string, std::string>> figures() const override;

    void end_source() override { input_.capture->stop(); }
    bool is_recording() const override { return recording_->file().has_value(); }
    std::string toggle_recording() override;

  private:
    void look(SessionCore& session);
    std::string detail() const;

    InterruptGuard interrupt_;
    LiveInput input_;
    std::shared_ptr<LiveRecording> recording_;
    std::filesystem::path out_;
    double seconds_;

    std::atomic<bool> begun_ = false;  ///< the session has taken a step
    std::optional<double> first_s_;    ///< when the first frame was exposed, on the source's clock
    double last_s_ = 0;
    std::vector<float> to_pose_s_, to_picture_s_;
    struct Picture {
        ViewReadback view;
        double exposed_s = 0;
    };
    std::optional<Picture> picture_;  ///< on its way
    bool ended_ = false;
    sensor::LiveCounts counts_;
    std::optional<CameraWatch> watch_;  // last: it uses the capture
};

}  // namespace patina::tools
