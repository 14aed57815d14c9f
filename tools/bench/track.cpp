// `patina bench track`: what tracking costs per frame and per iteration. See docs/develop/benchmarks.md.
#include <map>
#include <memory>

#include <CLI/CLI.hpp>

#include "engine/core/error.h"
#include "reconstruction/pipeline.h"
#include "reconstruction/session/rgbd_frame.h"
#include "tools/bench/processor_time.h"
#include "tools/bench/recording.h"
#include "tools/bench/subjects.h"

namespace patina::bench {
namespace track_bench {
namespace {

struct Options {
    std::string sequence = "synthetic:office";
    TrackingSettings tracking;
};

/// Device time of each pass in one frame, all of its runs together.
using FrameTimes = std::map<std::string, float>;

bool is_tracking(const std::string& pass) { return pass.find("tracking.") != std::string::npos; }

/// Shown beside the tracking, as a measure of how busy the machine is.
constexpr const char* kYardstick = "fusion.raycast";

/// One reconstruction that tracks, frame by frame.
class Bench {
  public:
    Bench(const Options& options, uint32_t warmup, const Recording& recording, vulkan::Device& device)
        : options_(options), warmup_(warmup), recording_(recording), pipeline_(device, settings()) {}

    void run() {
        for (const Frame& frame : recording_.frames) {
            pipeline_.runner().clear_timings();
            RgbdFrame rgbd = patina::to_rgbd(recording_.info, frame);
            rgbd.world_from_depth = *recording_.frames.front().world_from_camera;
            const double start = processor_ms();
            const bool fused = pipeline_.add(rgbd);
            pipeline_.wait();
            if (!fused) ++lost_;
            if (&frame - recording_.frames.data() >= warmup_) keep(processor_ms() - start);
        }
    }

    void report(Report& report) const {
        std::map<std::string, std::vector<float>> by_pass;
        std::vector<float> tracking;
        for (const FrameTimes& times : frames_) {
            float sum = 0;
            for (const auto& [pass, ms] : times) {
                if (is_tracking(pass) || pass == kYardstick) by_pass[pass].push_back(ms);
                if (is_tracking(pass)) sum += ms;
            }
            tracking.push_back(sum);
        }
        report.print("{:<36} {:>10} {:>10} {:>10} {:>6}\n", "ms per frame", "min", "median", "90 %", "runs");
        for (const auto& [pass, samples] : by_pass) add_row(report, pass, distribution(samples), runs_.at(pass));
        add_row(report, "tracking", distribution(tracking), 1);
        add_row(report, "processor time of the frame", distribution(processor_ms_), 1);
        report.print("{} of {} frames did not track\n", lost_, recording_.frames.size());
        report.json["lost_frames"] = lost_;
    }

  private:
    ReconstructionSettings settings() const {
        ReconstructionSettings settings;
        settings.tracking = options_.tracking;
        return settings;
    }

    void keep(double processor) {
        FrameTimes times;
        for (const graph::Timing& timing : pipeline_.runner().pass_timings()) {
            for (const float ms : timing.samples_ms) times[timing.name] += ms;
            if (!timing.samples_ms.empty()) runs_[timing.name] = timing.samples_ms.size();
        }
        frames_.push_back(std::move(times));
        processor_ms_.push_back(static_cast<float>(processor));
    }

    static void add_row(Report& report, const std::string& name, const Distribution& d, size_t runs) {
        report.print("{:<36} {:>10.4f} {:>10.4f} {:>10.4f} {:>6}\n", name, d.min, d.median, d.p90, runs);
        report.json["ms"][name] = to_json(d);
        report.json["ms"][name]["runs"] = runs;
    }

    const Options& options_;
    uint32_t warmup_;
    const Recording& recording_;
    Pipeline pipeline_;
    std::vector<FrameTimes> frames_;
    std::map<std::string, size_t> runs_;  ///< of each pass in a frame
    std::vector<float> processor_ms_;
    uint32_t lost_ = 0;
};

Report run(const Options& options, const Conditions& conditions) {
    const Recording recording =
        load({options.sequence, {}, conditions.extent, conditions.frames + conditions.warmup}, conditions.device);
    vulkan::Device device(conditions.device);
    Bench bench(options, conditions.warmup, recording, device);
    bench.run();
    const Extent2D extent = recording.info.depth.extent;
    Report report(device.caps());
    report.print("{} at {}x{}, {} frames\n\n", options.sequence, extent.width, extent.height, conditions.frames);
    bench.report(report);
    return report;
}

}  // namespace
}  // namespace track_bench

Subject track_subject() {
    using namespace track_bench;
    return {"track",
            "What tracking the camera costs",
            {.warmup = 4, .frames = 40, .extent = "512x424"},
            [](CLI::App& app) -> Measure {
                const auto options = std::make_shared<Options>();
                app.add_option("sequence", options->sequence, "Folder of a sequence, or synthetic:SCENE")
                    ->capture_default_str();
                app.add_option("--finest", options->tracking.finest, "The finest level that is compared")
                    ->capture_default_str();
                app.add_option("--iterations", options->tracking.iterations, "On each level")->capture_default_str();
                app.add_option("--finest-iterations", options->tracking.finest_iterations, "On the finest")
                    ->capture_default_str();
                app.add_flag("!--no-color", options->tracking.photometric, "Compare depths alone");
                return [options](const Conditions& conditions) { return run(*options, conditions); };
            }};
}

}  // namespace patina::bench
