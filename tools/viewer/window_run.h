#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tools/viewer/viewer.h"
#include "tools/viewer/viewer_options.h"

namespace patina::tools {

/// Shows a run's scene while it grows, beside whoever else goes along.
class WindowRun : public RunCompanion {
  public:
    /// As show_run().
    WindowRun(const ViewerOptions& options, const RunOptions& run, RunCompanion* inner,
              std::function<void()> end_source);
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
    void show(SessionCore& session);
    void draw(SessionCore& session, double patience_s);
    void take_wishes(SessionCore& session);
    void export_now(SessionCore& session);
    ViewerFacts facts_of(SessionCore& session) const;
    /// Whether the user has closed the window, and wants the run to end.
    bool closed();

    ViewerOptions options_;
    std::filesystem::path out_;
    RunCompanion* inner_;
    std::function<void()> end_source_;
    std::unique_ptr<Display> display_;  ///< null once the run has ended
    std::optional<Viewer> viewer_;      ///< from the device on
    std::optional<RigidTransform> sensor_;
    std::string progress_, message_, problem_;
    bool begun_ = false, closed_ = false;
};

}  // namespace patina::tools
