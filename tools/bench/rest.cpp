// patina_rest_bench: how the work of a frame falls when the camera rests and nothing moves. See docs/benchmarks.md.
#include <array>
#include <exception>
#include <map>
#include <numeric>
#include <span>

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
    std::string sequence = "synthetic:cubes";
    std::string extent = "512x424";
    float voxel_m = 0.02f;
    uint32_t lights = 3;
    uint32_t frames = 40;
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
void set_lights(Reconstruction& reconstruction, const RgbdFrame& frame, uint32_t count) {
    std::vector<PointLight> lamps;
    for (uint32_t i = 0; i < count; ++i) {
        const auto across = static_cast<float>(i % 4) - 1.5f, along = static_cast<float>(i / 4);
        lamps.push_back({glm::vec3(frame.world_from_depth * glm::dvec4(1.5f * across, -1.5f, 1.5f * along, 1)),
                         glm::vec3(3), 0.05f});
    }
    reconstruction.reflectance()->set_lights(lamps, glm::vec3(0.02f));
}

/// Adds the frame again and again to a new reconstruction, each alone on the device.
std::vector<FrameTimes> rest(vulkan::Device& device, const Options& options, const RgbdFrame& frame, uint32_t frames) {
    Reconstruction reconstruction(device, settings_of(options));
    set_lights(reconstruction, frame, options.lights);
    std::vector<FrameTimes> all;
    for (uint32_t i = 0; i < frames; ++i) {
        reconstruction.runner().clear_timings();
        const double start = processor_ms();
        reconstruction.add(frame);
        reconstruction.wait();
        FrameTimes& times = all.emplace_back();
        times.processor_ms = (processor_ms() - start) / 2;
        for (const graph::Timing& timing : reconstruction.runner().pass_timings())
            times.passes_ms[timing.name] = std::accumulate(timing.samples_ms.begin(), timing.samples_ms.end(), 0.0);
    }
    return all;
}

/// The runs do the same: the least that one of them took is what it takes when nothing else runs.
std::vector<FrameTimes> least_of_runs(vulkan::Device& device, const Options& options, const RgbdFrame& frame) {
    rest(device, options, frame, std::min(options.frames, 2u));  // compiles
    std::vector<FrameTimes> least = rest(device, options, frame, options.frames);
    for (uint32_t run = 1; run < options.runs; ++run) {
        const std::vector<FrameTimes> again = rest(device, options, frame, options.frames);
        for (uint32_t i = 0; i < options.frames; ++i) {
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

/// `averaged`: how many of the first and of the last frames are compared.
void print(std::span<const FrameTimes> frames, uint32_t averaged) {
    fmt::print("{:>6}", "frame");
    for (const char* name : kStageNames) fmt::print(" {:>12}", name);
    fmt::print(" {:>14}", "processor / 2");
    for (size_t i = 0; i < frames.size(); ++i) {
        fmt::print("\n{:>6}", i);
        for (size_t stage = 0; stage < kStages; ++stage)
            fmt::print(" {:>12.2f}", frames[i].stage_ms(static_cast<Stage>(stage)));
        fmt::print(" {:>14.2f}", frames[i].processor_ms);
    }
    const auto first = frames.first(averaged), last = frames.last(averaged);
    fmt::print("\n\n{:<40} {:>9} {:>9}\n", "ms, means of frames", "first", "last");
    for (const auto& [pass, ms] : frames.front().passes_ms) {
        if (stage_of(pass) != kGeometry)
            fmt::print("{:<40} {:>9.2f} {:>9.2f}\n", pass, mean_of_pass(first, pass), mean_of_pass(last, pass));
    }
    for (const Stage stage : {kObservation, kRefinement}) {
        const double before = mean_of_stage(first, stage), after = mean_of_stage(last, stage);
        fmt::print("{:<40} {:>9.2f} {:>9.2f}  falls by {:.1f}\n", kStageNames[stage], before, after, before / after);
    }
}

void run(const Options& options) {
    const vulkan::DeviceOptions device_options = options.device.options();
    const Recording recording = load({options.sequence, {}, tools::parse_extent(options.extent), 1}, device_options);
    const RgbdFrame frame = tools::to_rgbd(recording.info, recording.frames.front());
    vulkan::Device device(device_options);
    if (!device.caps().timestamps) throw Error("the device '", device.caps().name, "' has no timestamps");
    const std::vector<FrameTimes> frames = least_of_runs(device, options, frame);
    fmt::print("{}, {}\nthe first frame of {} at {} again and again, {} m, {} lights\n\n", device.caps().name,
               device.caps().driver, options.sequence, options.extent, options.voxel_m, options.lights);
    print(frames, options.averaged);
}

}  // namespace

}  // namespace patina::bench

int main(int argc, char** argv) {
    using namespace patina;
    CLI::App app("Measures what a frame costs while the camera rests", "patina_rest_bench");
    bench::Options options;
    app.add_option("sequence", options.sequence, "Folder of a sequence, or synthetic:SCENE; its first frame is taken")
        ->capture_default_str();
    app.add_option("--extent", options.extent, "Resample colour and depth to WIDTHxHEIGHT")->capture_default_str();
    app.add_option("--voxel", options.voxel_m, "Size of the observations' voxels, 0.02 or 0.01 m")
        ->capture_default_str();
    app.add_option("--lights", options.lights, "Point lights")
        ->capture_default_str()
        ->check(CLI::Range(0u, gpu::kMaxPointLights));
    app.add_option("--frames", options.frames, "How often to add the frame")
        ->capture_default_str()
        ->check(CLI::PositiveNumber);
    app.add_option("--averaged", options.averaged, "How many of the first and of the last are compared")
        ->capture_default_str()
        ->check(CLI::PositiveNumber);
    app.add_option("--runs", options.runs, "How often all of it is done; of each pass the least time counts")
        ->capture_default_str()
        ->check(CLI::PositiveNumber);
    options.device.add_to(app);
    CLI11_PARSE(app, argc, argv);
    try {
        if (options.averaged > options.frames) throw Error("--averaged is more than --frames");
        bench::run(options);
    } catch (const std::exception& error) {
        fmt::print(stderr, "patina_rest_bench: {}\n", error.what());
        return 1;
    }
    return 0;
}
