// patina_bench: how fast a recording is reconstructed. See docs/benchmarks.md.
#include <cstdio>
#include <exception>
#include <fstream>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "engine/core/error.h"
#include "tools/bench/measure.h"
#include "tools/bench/recording.h"
#include "tools/commands/commands.h"
#include "tools/commands/parse.h"
#include "tools/run_settings.h"

namespace patina::bench {

namespace {

using nlohmann::ordered_json;

constexpr float kMiB = 1024 * 1024;

struct Options {
    RecordingOptions recording;
    tools::DeviceArguments device;
    std::string extent;
    uint32_t frames = 60;
    uint32_t warmup = 20;
    bool no_color = false;
    std::vector<std::string> assignments;
    std::filesystem::path json, dump;
};

ordered_json to_json(const Distribution& d) {
    return {{"count", d.count}, {"min", d.min}, {"median", d.median}, {"p90", d.p90}};
}

ordered_json to_json(const std::vector<PassTimes>& passes) {
    ordered_json list = ordered_json::array();
    for (const PassTimes& pass : passes) list.push_back({{"name", pass.name}, {"ms", to_json(pass.ms)}});
    return list;
}

ordered_json to_json(const Measurement& m, const Recording& recording, const ReconstructionSettings& settings) {
    ordered_json pools;
    for (const auto& pool : m.pools) pools[pool.name] = pool.bytes;
    return {{"device", m.device},
            {"driver", m.driver},
            {"sequence", recording.info.name},
            {"extent", {recording.info.depth.extent.width, recording.info.depth.extent.height}},
            {"settings", tools::settings_json(settings)},
            {"frames", m.frames},
            {"passes", to_json(m.passes)},
            {"geometry_ms", m.geometry_ms},
            {"transfers_ms", m.transfers_ms},
            {"dispatches", m.dispatches},
            {"frame_passes", m.frame_passes},
            {"late_compilations", m.late_compilations},
            {"integrate_ms", to_json(m.integrate_ms)},
            {"integrate_mvoxel_s", to_json(m.integrate_mvoxel_s)},
            {"allocate_ms", to_json(m.allocate_ms)},
            {"raycast_ms", to_json(m.raycast_ms)},
            {"visible_mvoxel", m.visible_mvoxel},
            {"submit_ms", to_json(m.submit_ms)},
            {"add_ms", to_json(m.add_ms)},
            {"allocated_mvoxel", m.allocated_mvoxel},
            {"refused_blocks", m.refused_blocks},
            {"surface_passes", to_json(m.surface_passes)},
            {"surface_ms", to_json(m.surface_ms)},
            {"surface_wall_ms", to_json(m.surface_wall_ms)},
            {"triangles", m.triangles},
            {"first_frame_s", m.first_frame_s},
            {"pools_bytes", pools},
            {"transient_bytes", m.transient_bytes},
            {"recording_bytes", m.recording_bytes},
            {"peak_resident_bytes", m.peak_resident_bytes}};
}

void print_passes(const std::vector<PassTimes>& passes) {
    fmt::print("{:<28} {:>5} {:>9} {:>9} {:>9}\n", "pass (GPU ms)", "count", "min", "median", "90 %");
    for (const PassTimes& pass : passes) {
        fmt::print("{:<28} {:>5} {:>9.3f} {:>9.3f} {:>9.3f}\n", pass.name, pass.ms.count, pass.ms.min, pass.ms.median,
                   pass.ms.p90);
    }
    fmt::print("\n");
}

void print_figure(const char* name, const Distribution& d, const char* unit) {
    fmt::print("{:<28} {:>9.3f} {} (min {:.3f}, 90 % {:.3f})\n", name, d.median, unit, d.min, d.p90);
}

void print_surface(const Measurement& m) {
    print_passes(m.surface_passes);
    fmt::print("{:<28} {:>9.3f} ms per million allocated voxels (wall {:.3f}; {:.2f} million voxels, {} triangles)\n",
               "marching cubes", m.surface_ms.median / m.allocated_mvoxel,
               m.surface_wall_ms.median / m.allocated_mvoxel, m.allocated_mvoxel, m.triangles);
}

void print_memory(const Measurement& m) {
    uint64_t pools = 0;
    for (const auto& pool : m.pools) pools += pool.bytes;
    fmt::print("{:<28} {:>9.1f} MiB pools + {:.1f} MiB transient\n", "device memory", static_cast<float>(pools) / kMiB,
               static_cast<float>(m.transient_bytes) / kMiB);
    fmt::print("{:<28} {:>9.1f} MiB (of it {:.1f} MiB recording)\n", "peak resident",
               static_cast<float>(m.peak_resident_bytes) / kMiB, static_cast<float>(m.recording_bytes) / kMiB);
}

void print_warnings(const Measurement& m) {
    if (m.late_compilations > 0)
        fmt::print("warning: {} frames compiled a new shape; raise --warmup\n", m.late_compilations);
    if (m.refused_blocks > 0)
        fmt::print("warning: the voxel pool grew late or was full: {} requests found no room\n", m.refused_blocks);
}

void print(const Measurement& m, const Recording& recording) {
    fmt::print("{}, {}\n{} at {}x{}, {} frames\n\n", m.device, m.driver, recording.info.name,
               recording.info.depth.extent.width, recording.info.depth.extent.height, m.frames);
    print_passes(m.passes);
    fmt::print("{:<28} {:>9.3f} ms in at most {} dispatches; transfers {:.3f} ms, {} passes in all\n",
               "geometry, sum of medians", m.geometry_ms, m.dispatches, m.transfers_ms, m.frame_passes);
    fmt::print("{:<28} {:>9.1f} Mvoxel/s (min {:.1f}, 90 % {:.1f}; {:.2f} million voxels visible)\n", "integration",
               m.integrate_mvoxel_s.median, m.integrate_mvoxel_s.min, m.integrate_mvoxel_s.p90, m.visible_mvoxel);
    print_figure("allocation", m.allocate_ms, "ms");
    print_figure("raycast", m.raycast_ms, "ms");
    print_figure("host: graph submit", m.submit_ms, "ms");
    print_figure("host: declare and submit", m.add_ms, "ms");
    fmt::print("{:<28} {:>9.3f} s\n\n", "first fused frame after", m.first_frame_s);
    print_surface(m);
    print_memory(m);
    print_warnings(m);
}

void run(Options& options) {
    ReconstructionSettings settings;
    settings.view_every_frame = true;
    settings.fusion.color = !options.no_color;
    for (const std::string& assignment : options.assignments) tools::apply_setting(settings, assignment);
    if (!options.extent.empty()) options.recording.extent = tools::parse_extent(options.extent);
    options.recording.frames = options.warmup + options.frames;
    const vulkan::DeviceOptions device = options.device.options();
    const Recording recording = load(options.recording, device);
    if (!options.dump.empty()) dump(recording, options.dump);
    const Measurement result = measure(recording, options.warmup, settings, device);
    print(result, recording);
    if (options.json.empty()) return;
    std::ofstream out(options.json);
    out << to_json(result, recording, settings).dump(2) << '\n';
    if (!out.flush()) throw Error("the file '", options.json.string(), "' cannot be written");
}

}  // namespace

}  // namespace patina::bench

int main(int argc, char** argv) {
    using namespace patina;
    CLI::App app("Measures how fast a recording is reconstructed", "patina_bench");
    bench::Options options;
    app.add_option("sequence", options.recording.sequence, "Folder of a sequence, or synthetic:SCENE")->required();
    app.add_option("--format", options.recording.format,
                   "patina-sequence, 7-scenes, tum or open3d, instead of recognising it");
    app.add_option("--extent", options.extent, "Resample colour and depth to WIDTHxHEIGHT");
    app.add_option("--frames", options.frames, "How many frames to measure")
        ->capture_default_str()
        ->check(CLI::PositiveNumber);
    // The default goes through one removal of empty blocks, whose frame has a shape of its own.
    app.add_option("--warmup", options.warmup, "How many frames to fuse before")->capture_default_str();
    app.add_flag("--no-color", options.no_color, "Fuse depth only");
    app.add_option("--set", options.assignments, "One setting as KEY=VALUE; may be repeated")->take_all();
    app.add_option("--json", options.json, "Write the figures to this file");
    app.add_option("--dump", options.dump, "Write the frames to this folder, for other programs");
    options.device.add_to(app);
    CLI11_PARSE(app, argc, argv);
    try {
        bench::run(options);
    } catch (const std::exception& error) {
        fmt::print(stderr, "patina_bench: {}\n", error.what());
        return 1;
    }
    return 0;
}
