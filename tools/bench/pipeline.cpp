// `patina bench`: what a frame takes with all stages on, over a built-in scene. See docs/develop/benchmarks.md.
#include "reconstruction/pipeline.h"

#include <array>
#include <chrono>
#include <map>
#include <memory>
#include <numeric>

#include <CLI/CLI.hpp>

#include "engine/core/error.h"
#include "reconstruction/session/network_file.h"
#include "reconstruction/session/rgbd_frame.h"
#include "reconstruction/setting_table.h"
#include "scenes/files/scene_file.h"
#include "tools/bench/recording.h"
#include "tools/bench/stages.h"
#include "tools/bench/subjects.h"

namespace patina::bench {
namespace pipeline_bench {
namespace {

using Clock = std::chrono::steady_clock;
using nlohmann::ordered_json;

struct Options {
    std::string scene = "office";
};

/// Everything that is measured on: frames in memory, the scene's own lights, and all stages.
struct Work {
    Recording recording;
    std::vector<Light> lights;
    ReconstructionSettings settings;
};

/// Device times, in milliseconds.
struct Times {
    std::array<std::vector<float>, kStages> stages;    ///< of each frame
    std::vector<float> frames;                         ///< of each frame, all stages together
    std::map<std::string, std::vector<float>> passes;  ///< of each frame that has the pass, all of its runs together
};

/// Given poses, known lights, segments, and specular materials by the network that ships and the fit.
ReconstructionSettings all_stages() {
    ReconstructionSettings settings;
    settings.reflectance.emplace();
    settings.segmentation.emplace();
    settings.specular.emplace();
    settings.network = read_network_file(scenes::assets_folder() / "hemicnn.safetensors");
    return settings;
}

Work prepare(const Options& options, const Conditions& conditions) {
    return {load({"synthetic:" + options.scene, {}, conditions.extent, conditions.warmup + conditions.frames},
                 conditions.device),
            scenes::load_scene(options.scene).lights, all_stages()};
}

float sum(const std::vector<float>& values) { return std::accumulate(values.begin(), values.end(), 0.0f); }

/// One reconstruction of the recording.
class Run {
  public:
    Run(vulkan::Device& device, const Work& work) : work_(work), pipeline_(device, work.settings) {
        pipeline_.set_lights(work.lights);
    }

    /// Fuses frames `first` to `end` - 1, each alone on the device; returns their times.
    Times fuse_alone(uint32_t first, uint32_t end) {
        Times times;
        for (uint32_t i = first; i < end; ++i) {
            pipeline_.runner().clear_timings();
            add(i);
            pipeline_.wait();
            add_times(times);
        }
        return times;
    }

    /// Fuses frames `first` to `end` - 1, two in flight; returns the frames per second.
    double fuse_in_flight(uint32_t first, uint32_t end) {
        pipeline_.wait();
        const auto start = Clock::now();
        for (uint32_t i = first; i < end; ++i) add(i);
        pipeline_.wait();
        return (end - first) / std::chrono::duration<double>(Clock::now() - start).count();
    }

  private:
    void add(uint32_t frame) { pipeline_.add(to_rgbd(work_.recording.info, work_.recording.frames[frame])); }

    void add_times(Times& times) {
        std::array<float, kStages> stages{};
        for (const graph::Timing& timing : pipeline_.runner().pass_timings()) {
            if (timing.samples_ms.empty()) continue;
            const float ms = sum(timing.samples_ms);
            times.passes[timing.name].push_back(ms);
            stages[stage_of(timing.name)] += ms;
        }
        for (size_t stage = 0; stage < kStages; ++stage) times.stages[stage].push_back(stages[stage]);
        times.frames.push_back(std::accumulate(stages.begin(), stages.end(), 0.0f));
    }

    const Work& work_;
    Pipeline pipeline_;
};

ordered_json passes_json(const Times& times) {
    ordered_json passes;
    for (const auto& [name, ms] : times.passes)
        passes.push_back({{"name", name}, {"stage", kStageNames[stage_of(name)]}, {"ms", to_json(distribution(ms))}});
    return passes;
}

void add_table(Report& report, const Times& times) {
    report.print("{:<25} {:>10} {:>10} {:>10}\n", "ms a frame, on the device", "median", "90 %", "share");
    const auto add_row = [&](std::string_view name, const std::vector<float>& ms) {
        const Distribution d = distribution(ms);
        const double share = sum(ms) / sum(times.frames);
        report.print("{:<25} {:>10.3f} {:>10.3f} {:>8.1f} %\n", name, d.median, d.p90, 100 * share);
        ordered_json& row = report.json["stages"][std::string(name)] = to_json(d);
        row["share"] = share;
    };
    for (size_t stage = 0; stage < kStages; ++stage) {
        if (stage != kOther || sum(times.stages[stage]) > 0) add_row(kStageNames[stage], times.stages[stage]);
    }
    add_row("all", times.frames);
}

Report run(const Options& options, const Conditions& conditions) {
    const Work work = prepare(options, conditions);
    vulkan::Device device(conditions.device);
    if (!device.caps().timestamps)
        throw Error("the device '", device.caps().name, "' has no timestamps, so its passes cannot be timed");
    const uint32_t measured = conditions.warmup, end = conditions.warmup + conditions.frames;
    Times times;
    {
        Run alone(device, work);
        alone.fuse_alone(0, measured);
        times = alone.fuse_alone(measured, end);
    }
    // A second reconstruction: the frames are new to it again, and its shaders are compiled.
    Run in_flight(device, work);
    in_flight.fuse_in_flight(0, measured);
    const double frames_per_second = in_flight.fuse_in_flight(measured, end);

    const Extent2D extent = work.recording.info.depth.extent;
    Report report(device.caps());
    report.print("{} at {}x{}, all stages, {} lights, {} frames after {}\n\n", options.scene, extent.width,
                 extent.height, work.lights.size(), conditions.frames, conditions.warmup);
    report.json.update({{"scene", options.scene},
                        {"extent", {extent.width, extent.height}},
                        {"lights", work.lights.size()},
                        {"warmup", conditions.warmup},
                        {"frames", conditions.frames}});
    add_table(report, times);
    report.print("{:<25} {:>10.1f}  two in flight, with the host's work\n", "frames per second", frames_per_second);
    report.json["frames_per_second"] = frames_per_second;
    report.json["passes"] = passes_json(times);
    report.json["settings"] = settings_json(work.settings);
    return report;
}

}  // namespace
}  // namespace pipeline_bench

Subject pipeline_subject() {
    using namespace pipeline_bench;
    return {"pipeline",
            "What a frame takes with all stages on",
            {.warmup = 20, .frames = 60, .extent = kAsRecorded},
            [](CLI::App& app) -> Measure {
                const auto options = std::make_shared<Options>();
                app.add_option("--scene", options->scene,
                               "Scene file or built-in scene (" + scenes::scene_names() + ") of the whole pipeline")
                    ->capture_default_str();
                return [options](const Conditions& conditions) { return run(*options, conditions); };
            }};
}

}  // namespace patina::bench
