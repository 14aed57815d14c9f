// `patina bench refine`: the refinement of albedos, on records that are made up. See docs/develop/benchmarks.md.
#include <cmath>
#include <memory>
#include <random>

#include <CLI/CLI.hpp>

#include "engine/core/error.h"
#include "engine/graph/runner.h"
#include "passes/reflectance/reflectance.h"
#include "tools/bench/filled_records.h"
#include "tools/bench/processor_time.h"
#include "tools/bench/subjects.h"

namespace patina::bench {
namespace refine_bench {
namespace {

struct Options {
    uint32_t records = 60000;
    uint32_t observations = gpu::kMaxObservations;
    uint32_t lights = 4;
    bool diffuse = false;
};

/// A floor of voxels side by side, each seen from random directions above it, of one glossy material.
std::vector<FilledRecord> floor_records(const Options& options, float voxel_m) {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> angle(0, 6.283f), cosine(0.3f, 1), level(0.1f, 0.6f);
    const auto width = static_cast<uint32_t>(std::sqrt(static_cast<float>(options.records))) + 1;
    std::vector<FilledRecord> records;
    for (uint32_t i = 0; i < options.records; ++i) {
        const glm::vec2 at = (glm::vec2(i % width, i / width) - 0.5f * static_cast<float>(width)) * voxel_m;
        FilledRecord record{{at.x, 0.3f * voxel_m, at.y}, {0, -1, 0}, 1, {}};
        for (uint32_t k = 0; k < options.observations; ++k) {
            const float up = cosine(random), around = angle(random), across = std::sqrt(1 - up * up);
            record.observations.push_back({{across * std::cos(around), -up, across * std::sin(around)},
                                           {level(random), level(random), level(random)},
                                           {}});
        }
        records.push_back(record);
    }
    return records;
}

/// The models, filled.
struct Bench {
    Bench(vulkan::Device& device, const Options& options)
        : voxel_map(device, {.capacity_blocks = 64}),
          map(device, {.capacity_blocks = 64, .capacity_records = options.records}),
          materials(device, 2),
          state(device, map),
          runner(device) {
        std::vector<Light> lamps;
        for (uint32_t i = 0; i < options.lights; ++i) {
            const float x = 2.0f * static_cast<float>(i % 8) - 4.0f, z = 2.0f * static_cast<float>(i / 8) - 4.0f;
            lamps.push_back({{x, -2.2f, z}, glm::dvec3(3), 0.05f});
        }
        lights.set(lamps, glm::dvec3(0.02f));
        if (!options.diffuse) materials.set(1, glm::vec3(0.1f), 0.2f);
        settings.shadows = false;
        settings.first_marched_records = settings.marched_records = UINT32_MAX;
        graph::FrameGraph frame = runner.begin();
        voxel_map.reset(frame, glm::dvec3(0));
        map.reset(frame, glm::dvec3(0));
        state.reset(frame);
        runner.submit(std::move(frame));
        frame = runner.begin();
        ObservationMapIds ids = map.import(frame);
        add_fill_records(frame, map, ids, floor_records(options, map.settings().voxel_m));
        ObservationMap::keep(frame, ids);
        runner.submit(std::move(frame));
    }

    /// One update in which `count` records have changed.
    void update(uint32_t count) {
        runner.wait();
        graph::FrameGraph frame = runner.begin();
        ObservationMapIds ids = map.import(frame);
        const RecordList changed = add_list_records(frame, count);
        add_refine_reflectance(frame, {voxel_map, map, lights, materials, state}, voxel_map.import(frame), ids, changed,
                               preferred_reflectance_access(runner.device().caps(), voxel_map, map), settings);
        ObservationMap::keep(frame, ids);
        runner.submit(std::move(frame));
        runner.wait();
    }

    /// Processor time of each of `frames` updates.
    std::vector<float> measure(uint32_t count, uint32_t frames) {
        std::vector<float> samples;
        for (uint32_t i = 0; i < frames; ++i) {
            const double start = processor_ms();
            update(count);
            samples.push_back(static_cast<float>(processor_ms() - start));
        }
        return samples;
    }

    VoxelMap voxel_map;
    ObservationMap map;
    Lights lights;
    SegmentMaterials materials;
    ReflectanceState state;
    ReflectanceSettings settings;
    graph::Runner runner;
};

Report run(const Options& options, const Conditions& conditions) {
    vulkan::Device device(conditions.device);
    Bench bench(device, options);
    bench.measure(options.records, conditions.warmup);
    bench.measure(0, 1);
    bench.runner.clear_timings();
    const Distribution all = distribution(bench.measure(options.records, conditions.frames));
    const auto timings = bench.runner.pass_timings();
    const Distribution none = distribution(bench.measure(0, conditions.frames));
    std::vector<Row> rows;
    for (const graph::Timing& timing : timings) {
        if (timing.name.starts_with("reflectance.")) rows.push_back({timing.name, distribution(timing.samples_ms)});
    }
    rows.push_back({"processor time of an update", all});
    rows.push_back({"the same, nothing to refine", none});
    Report report(device.caps());
    report.print("{} records with {} observations and {} lights, {} frames\n\n", options.records, options.observations,
                 options.lights, conditions.frames);
    report.table("ms", rows);
    report.difference("refinement", all, none);
    return report;
}

}  // namespace
}  // namespace refine_bench

Subject refine_subject() {
    using namespace refine_bench;
    return {"refine",
            "How long the refinement of albedos takes, on records that are made up",
            {.warmup = 4, .frames = 40},
            [](CLI::App& app) -> Measure {
                const auto options = std::make_shared<Options>();
                app.add_option("--records", options->records, "Voxels to refine")
                    ->capture_default_str()
                    ->check(CLI::Range(1u, 262144u));
                app.add_option("--observations", options->observations, "Of each of them")
                    ->capture_default_str()
                    ->check(CLI::Range(1u, gpu::kMaxObservations));
                app.add_option("--lights", options->lights, "Point lights")
                    ->capture_default_str()
                    ->check(CLI::Range(0u, gpu::kMaxPointLights));
                app.add_flag("--diffuse", options->diffuse, "Without a specular material");
                return [options](const Conditions& conditions) { return run(*options, conditions); };
            }};
}

}  // namespace patina::bench
