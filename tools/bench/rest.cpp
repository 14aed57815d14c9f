// `patina bench rest`: how the work of a frame falls while the camera rests. See docs/develop/benchmarks.md.
#include <array>
#include <map>
#include <memory>
#include <numeric>
#include <span>

#include <CLI/CLI.hpp>

#include "engine/core/error.h"
#include "reconstruction/pipeline.h"
#include "reconstruction/session/rgbd_frame.h"
#include "tools/bench/processor_time.h"
#include "tools/bench/recording.h"
#include "tools/bench/subjects.h"

namespace patina::bench {
namespace rest_bench {
namespace {

struct Options {
    std::string sequence = "synthetic:cubes";
    float voxel_m = 0.02f;
    uint32_t lights = 3;
    uint32_t averaged = 4;
    uint32_t runs = 3;
};

enum Stage : size_t { kGeometry, kObservation, kRefinement, kStages };
constexpr std::array<const char*, kStages> kStageNames = {"geometry", "observation", "refinement"};

/// Device time of one frame by pass, and processor time over two cores.
struct FrameTimes {
    std::map<std::string, double> passes_ms;
    double processor_ms = 0;

    double stage_ms(Stage stage) const;
};

/// Of a pass, or of a transfer on its behalf.
Stage stage_of(const std::string& pass) {
    if (pass.find("observation.") != std::string::npos) return kObservation;
    return pass.find("reflectance.") != std::string::npos ? kRefinement : kGeometry;
}

double FrameTimes::stage_ms(Stage stage) const {
    double sum = 0;
    for (const auto& [pass, ms] : passes_ms) sum += stage_of(pass) == stage ? ms : 0;
    return sum;
}

ReconstructionSettings settings_of(const Options& options) {
    ReconstructionSettings settings;
    settings.reflectance.emplace();
    settings.reflectance->voxel_m = options.voxel_m;
    return settings;
}

/// Lamps above the recording's first camera.
void set_lights(Pipeline& pipeline, const RgbdFrame& frame, uint32_t count) {
    std::vector<Light> lamps;
    for (uint32_t i = 0; i < count; ++i) {
        const auto across = static_cast<float>(i % 4) - 1.5f, along = static_cast<float>(i / 4);
        lamps.push_back({glm::dvec3(frame.world_from_depth * glm::dvec4(1.5f * across, -1.5f, 1.5f * along, 1)),
                         glm::dvec3(3), 0.05f});
    }
    pipeline.set_lights(lamps, glm::dvec3(0.02f));
}

/// Adds the frame again and again to a new reconstruction, each alone on the device.
std::vector<FrameTimes> rest(vulkan::Device& device, const Options& options, const RgbdFrame& frame, uint32_t frames) {
    Pipeline pipeline(device, settings_of(options));
    set_lights(pipeline, frame, options.lights);
    std::vector<FrameTimes> all;
    for (uint32_t i = 0; i < frames; ++i) {
        pipeline.runner().clear_timings();
        const double start = processor_ms();
        pipeline.add(frame);
        pipeline.wait();
        FrameTimes& times = all.emplace_back();
        times.processor_ms = (processor_ms() - start) / 2;
        for (const graph::Timing& timing : pipeline.runner().pass_timings())
            times.passes_ms[timing.name] = std::accumulate(timing.samples_ms.begin(), timing.samples_ms.end(), 0.0);
    }
    return all;
}

/// The runs do the same: the least that one of them took is what it takes when nothing else runs.
std::vector<FrameTimes> least_of_runs(vulkan::Device& device, const Options& options, const RgbdFrame& frame,
                                      uint32_t frames) {
    rest(device, options, frame, std::min(frames, 2u));  // compiles
    std::vector<FrameTimes> least = rest(device, options, frame, frames);
    for (uint32_t run = 1; run < options.runs; ++run) {
        const std::vector<FrameTimes> again = rest(device, options, frame, frames);
        for (uint32_t i = 0; i < frames; ++i) {
            least[i].processor_ms = std::min(least[i].processor_ms, again[i].processor_ms);
            for (auto& [pass, ms] : least[i].passes_ms) ms = std::min(ms, again[i].passes_ms.at(pass));
        }
    }
    return least;
}

double mean_of_stage(std::span<const FrameTimes> frames, Stage stage) {
    double sum = 0;
    for (const FrameTimes& times : frames) sum += times.stage_ms(stage);
    return sum / static_cast<double>(frames.size());
}

double mean_of_pass(std::span<const FrameTimes> frames, const std::string& pass) {
    double sum = 0;
    for (const FrameTimes& times : frames) {
        const auto at = times.passes_ms.find(pass);
        sum += at == times.passes_ms.end() ? 0 : at->second;
    }
    return sum / static_cast<double>(frames.size());
}

void report_frames(Report& report, std::span<const FrameTimes> frames) {
    report.print("{:>6}", "frame");
    for (const char* name : kStageNames) report.print(" {:>12}", name);
    report.print(" {:>14}", "processor / 2");
    for (size_t i = 0; i < frames.size(); ++i) {
        report.print("\n{:>6}", i);
        nlohmann::ordered_json times;
        for (size_t stage = 0; stage < kStages; ++stage) {
            const double ms = frames[i].stage_ms(static_cast<Stage>(stage));
            report.print(" {:>12.2f}", ms);
            times[kStageNames[stage]] = ms;
        }
        report.print(" {:>14.2f}", frames[i].processor_ms);
        times["processor"] = frames[i].processor_ms;
        report.json["frames_ms"].push_back(std::move(times));
    }
}

/// Compares the first frames with the last.
void report_fall(Report& report, std::span<const FrameTimes> first, std::span<const FrameTimes> last) {
    report.print("\n\n{:<40} {:>9} {:>9}\n", "ms, means of frames", "first", "last");
    for (const auto& [pass, ms] : first.front().passes_ms) {
        if (stage_of(pass) == kGeometry) continue;
        const double before = mean_of_pass(first, pass), after = mean_of_pass(last, pass);
        report.print("{:<40} {:>9.2f} {:>9.2f}\n", pass, before, after);
        report.json["ms"][pass] = {{"first", before}, {"last", after}};
    }
    for (const Stage stage : {kObservation, kRefinement}) {
        const double before = mean_of_stage(first, stage), after = mean_of_stage(last, stage);
        report.print("{:<40} {:>9.2f} {:>9.2f}  falls by {:.1f}\n", kStageNames[stage], before, after, before / after);
        report.json["ms"][kStageNames[stage]] = {{"first", before}, {"last", after}};
    }
}

Report run(const Options& options, const Conditions& conditions) {
    if (options.averaged > conditions.frames) throw Error("--averaged is more than --frames");
    const Recording recording = load({options.sequence, {}, conditions.extent, 1}, conditions.device);
    const RgbdFrame frame = patina::to_rgbd(recording.info, recording.frames.front());
    vulkan::Device device(conditions.device);
    if (!device.caps().timestamps) throw Error("the device '", device.caps().name, "' has no timestamps");
    const std::vector<FrameTimes> times = least_of_runs(device, options, frame, conditions.frames);
    const std::span<const FrameTimes> frames = times;
    const Extent2D extent = recording.info.depth.extent;
    Report report(device.caps());
    report.print("the first frame of {} at {}x{} again and again, {} m, {} lights\n\n", options.sequence, extent.width,
                 extent.height, options.voxel_m, options.lights);
    report_frames(report, frames);
    report_fall(report, frames.first(options.averaged), frames.last(options.averaged));
    return report;
}

}  // namespace
}  // namespace rest_bench

Subject rest_subject() {
    using namespace rest_bench;
    return {"rest",
            "How the work of a frame falls while the camera rests and nothing moves",
            {.frames = 40, .extent = "512x424"},
            [](CLI::App& app) -> Measure {
                const auto options = std::make_shared<Options>();
                app.add_option("sequence", options->sequence,
                               "Folder of a sequence, or synthetic:SCENE; its first frame is taken")
                    ->capture_default_str();
                app.add_option("--voxel", options->voxel_m, "Size of the observations' voxels, 0.02 or 0.01 m")
                    ->capture_default_str();
                app.add_option("--lights", options->lights, "Point lights")
                    ->capture_default_str()
                    ->check(CLI::Range(0u, gpu::kMaxPointLights));
                app.add_option("--averaged", options->averaged, "How many of the first and of the last are compared")
                    ->capture_default_str()
                    ->check(CLI::PositiveNumber);
                app.add_option("--runs", options->runs,
                               "How often all of it is done; of each pass the least time counts")
                    ->capture_default_str()
                    ->check(CLI::PositiveNumber);
                return [options](const Conditions& conditions) { return run(*options, conditions); };
            }};
}

}  // namespace patina::bench
