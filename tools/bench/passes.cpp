// `patina bench passes`: how fast a recording is reconstructed. See docs/develop/benchmarks.md.

#include <memory>

#include <CLI/CLI.hpp>

#include "engine/core/error.h"
#include "reconstruction/setting_table.h"
#include "sensor/open.h"
#include "tools/bench/measure.h"
#include "tools/bench/recording.h"
#include "tools/bench/subjects.h"

namespace patina::bench {
namespace passes_bench {
namespace {

using nlohmann::ordered_json;

constexpr float kMiB = 1024 * 1024;

struct Options {
    RecordingOptions recording;
    bool no_color = false;
    std::vector<std::string> assignments;
    std::filesystem::path dump;
};

ordered_json to_json(const std::vector<PassTimes>& passes) {
    ordered_json list = ordered_json::array();
    for (const PassTimes& pass : passes) list.push_back({{"name", pass.name}, {"ms", to_json(pass.ms)}});
    return list;
}

ordered_json to_json(const Measurement& m, const Recording& recording, const ReconstructionSettings& settings) {
    ordered_json pools;
    for (const auto& pool : m.pools) pools[pool.name] = pool.bytes;
    return {{"sequence", recording.info.name},
            {"extent", {recording.info.depth.extent.width, recording.info.depth.extent.height}},
            {"settings", patina::settings_json(settings)},
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

void print_passes(Report& report, const std::vector<PassTimes>& passes) {
    report.print("{:<28} {:>5} {:>9} {:>9} {:>9}\n", "pass (GPU ms)", "count", "min", "median", "90 %");
    for (const PassTimes& pass : passes) {
        report.print("{:<28} {:>5} {:>9.3f} {:>9.3f} {:>9.3f}\n", pass.name, pass.ms.count, pass.ms.min, pass.ms.median,
                     pass.ms.p90);
    }
    report.print("\n");
}

void print_figure(Report& report, const char* name, const Distribution& d, const char* unit) {
    report.print("{:<28} {:>9.3f} {} (min {:.3f}, 90 % {:.3f})\n", name, d.median, unit, d.min, d.p90);
}

void print_surface(Report& report, const Measurement& m) {
    print_passes(report, m.surface_passes);
    report.print("{:<28} {:>9.3f} ms per million allocated voxels (wall {:.3f}; {:.2f} million voxels, {} triangles)\n",
                 "marching cubes", m.surface_ms.median / m.allocated_mvoxel,
                 m.surface_wall_ms.median / m.allocated_mvoxel, m.allocated_mvoxel, m.triangles);
}

void print_memory(Report& report, const Measurement& m) {
    uint64_t pools = 0;
    for (const auto& pool : m.pools) pools += pool.bytes;
    report.print("{:<28} {:>9.1f} MiB pools + {:.1f} MiB transient\n", "device memory",
                 static_cast<float>(pools) / kMiB, static_cast<float>(m.transient_bytes) / kMiB);
    report.print("{:<28} {:>9.1f} MiB (of it {:.1f} MiB recording)\n", "peak resident",
                 static_cast<float>(m.peak_resident_bytes) / kMiB, static_cast<float>(m.recording_bytes) / kMiB);
}

void print_warnings(Report& report, const Measurement& m) {
    if (m.late_compilations > 0)
        report.print("warning: {} frames compiled a new shape; raise --warmup\n", m.late_compilations);
    if (m.refused_blocks > 0)
        report.print("warning: the voxel pool grew late or was full: {} requests found no room\n", m.refused_blocks);
}

void print(Report& report, const Measurement& m, const Recording& recording) {
    report.print("{} at {}x{}, {} frames\n\n", recording.info.name, recording.info.depth.extent.width,
                 recording.info.depth.extent.height, m.frames);
    print_passes(report, m.passes);
    report.print("{:<28} {:>9.3f} ms in at most {} dispatches; transfers {:.3f} ms, {} passes in all\n",
                 "geometry, sum of medians", m.geometry_ms, m.dispatches, m.transfers_ms, m.frame_passes);
    report.print("{:<28} {:>9.1f} Mvoxel/s (min {:.1f}, 90 % {:.1f}; {:.2f} million voxels visible)\n", "integration",
                 m.integrate_mvoxel_s.median, m.integrate_mvoxel_s.min, m.integrate_mvoxel_s.p90, m.visible_mvoxel);
    print_figure(report, "allocation", m.allocate_ms, "ms");
    print_figure(report, "raycast", m.raycast_ms, "ms");
    print_figure(report, "host: graph submit", m.submit_ms, "ms");
    print_figure(report, "host: declare and submit", m.add_ms, "ms");
    report.print("{:<28} {:>9.3f} s\n\n", "first fused frame after", m.first_frame_s);
    print_surface(report, m);
    print_memory(report, m);
    print_warnings(report, m);
}

Report run(const Options& options, const Conditions& conditions) {
    ReconstructionSettings settings;
    settings.view_every_frame = true;
    settings.fusion.color = !options.no_color;
    for (const std::string& assignment : options.assignments) patina::apply_setting(settings, assignment, "--set");
    RecordingOptions wanted = options.recording;
    wanted.extent = conditions.extent;
    wanted.frames = conditions.warmup + conditions.frames;
    const Recording recording = load(wanted, conditions.device);
    if (!options.dump.empty()) dump(recording, options.dump);
    const Measurement result = measure(recording, conditions.warmup, settings, conditions.device);
    Report report(result.caps);
    print(report, result, recording);
    report.json.update(to_json(result, recording, settings));
    return report;
}

}  // namespace
}  // namespace passes_bench

Subject passes_subject() {
    using namespace passes_bench;
    return {"passes",
            "How fast a recording is fused, pass by pass",
            {.warmup = 20, .frames = 60, .extent = kAsRecorded},
            [](CLI::App& app) -> Measure {
                const auto options = std::make_shared<Options>();
                app.add_option("sequence", options->recording.sequence, "Folder of a sequence, or synthetic:SCENE")
                    ->required();
                app.add_option("--format", options->recording.format,
                               sensor::format_names() + ", instead of recognising it");
                app.add_flag("--no-color", options->no_color, "Fuse depth only");
                app.add_option("--set", options->assignments, "One setting as KEY=VALUE; may be repeated")->take_all();
                app.add_option("--dump", options->dump, "Write the frames to this folder, for other programs");
                return [options](const Conditions& conditions) { return run(*options, conditions); };
            }};
}

}  // namespace patina::bench
