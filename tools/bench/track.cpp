// patina_track_bench: what tracking costs per frame and per iteration. See docs/benchmarks.md.
#include <cstdio>
#include <exception>
#include <map>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "engine/core/error.h"
#include "passes/reconstruction.h"
#include "tools/bench/distribution.h"
#include "tools/bench/processor_time.h"
#include "tools/bench/recording.h"
#include "tools/commands/commands.h"
#include "tools/commands/parse.h"
#include "tools/rgbd_frame.h"

namespace patina::bench {

namespace {

struct Options {
    tools::DeviceArguments device;
    std::string sequence = "synthetic:office";
    std::string extent = "512x424";
    uint32_t frames = 40;
    uint32_t warmup = 4;
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
    Bench(const Options& options, const Recording& recording, vulkan::Device& device)
        : options_(options), recording_(recording), reconstruction_(device, settings()) {}

    void run() {
        for (const sensor::Frame& frame : recording_.frames) {
            reconstruction_.runner().clear_timings();
            RgbdFrame rgbd = tools::to_rgbd(recording_.info, frame);
            rgbd.world_from_depth = *recording_.frames.front().world_from_camera;
            const double start = processor_ms();
            const bool fused = reconstruction_.add(rgbd);
            reconstruction_.wait();
            if (!fused) ++lost_;
            if (&frame - recording_.frames.data() >= options_.warmup) keep(processor_ms() - start);
        }
    }

    void print() const {
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
        fmt::print("{:<36} {:>9} {:>9} {:>9} {:>9}\n", "ms per frame", "min", "median", "90 %", "runs");
        for (const auto& [pass, samples] : by_pass) print(pass, distribution(samples), runs_.at(pass));
        print("tracking", distribution(tracking), 1);
        print("processor time of the frame", distribution(processor_ms_), 1);
        fmt::print("{} of {} frames did not track\n", lost_, recording_.frames.size());
    }

  private:
    ReconstructionSettings settings() const {
        ReconstructionSettings settings;
        settings.tracking = options_.tracking;
        return settings;
    }

    void keep(double processor) {
        FrameTimes times;
        for (const graph::Timing& timing : reconstruction_.runner().pass_timings()) {
            for (const float ms : timing.samples_ms) times[timing.name] += ms;
            if (!timing.samples_ms.empty()) runs_[timing.name] = timing.samples_ms.size();
        }
        frames_.push_back(std::move(times));
        processor_ms_.push_back(static_cast<float>(processor));
    }

    static void print(const std::string& name, const Distribution& d, size_t runs) {
        fmt::print("{:<36} {:>9.3f} {:>9.3f} {:>9.3f} {:>9}\n", name, d.min, d.median, d.p90, runs);
    }

    const Options& options_;
    const Recording& recording_;
    Reconstruction reconstruction_;
    std::vector<FrameTimes> frames_;
    std::map<std::string, size_t> runs_;  ///< of each pass in a frame
    std::vector<float> processor_ms_;
    uint32_t lost_ = 0;
};

void run(const Options& options) {
    const vulkan::DeviceOptions device_options = options.device.options();
    const Recording recording = load(
        {options.sequence, {}, tools::parse_extent(options.extent), options.frames + options.warmup}, device_options);
    vulkan::Device device(device_options);
    fmt::print("{}, {}\n{} at {}, {} frames\n\n", device.caps().name, device.caps().driver, options.sequence,
               options.extent, options.frames);
    Bench bench(options, recording, device);
    bench.run();
    bench.print();
}

}  // namespace

}  // namespace patina::bench

int main(int argc, char** argv) {
    using namespace patina;
    CLI::App app("Measures what tracking the camera costs", "patina_track_bench");
    bench::Options options;
    app.add_option("sequence", options.sequence, "Folder of a sequence, or synthetic:SCENE")->capture_default_str();
    app.add_option("--extent", options.extent, "Resample colour and depth to WIDTHxHEIGHT")->capture_default_str();
    app.add_option("--frames", options.frames, "How many frames to measure")
        ->capture_default_str()
        ->check(CLI::PositiveNumber);
    app.add_option("--warmup", options.warmup, "How many frames before")
        ->capture_default_str()
        ->check(CLI::PositiveNumber);
    app.add_option("--finest", options.tracking.finest, "The finest level that is compared")->capture_default_str();
    app.add_option("--iterations", options.tracking.iterations, "On each level")->capture_default_str();
    app.add_option("--finest-iterations", options.tracking.finest_iterations, "On the finest")->capture_default_str();
    app.add_flag("!--no-color", options.tracking.photometric, "Compare depths alone");
    options.device.add_to(app);
    CLI11_PARSE(app, argc, argv);
    try {
        bench::run(options);
    } catch (const std::exception& error) {
        fmt::print(stderr, "patina_track_bench: {}\n", error.what());
        return 1;
    }
    return 0;
}
