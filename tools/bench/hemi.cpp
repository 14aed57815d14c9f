// `patina bench hemi`: how long HemiImages, the network and the fusion of its estimates take, on segments that are made
// up. See docs/develop/benchmarks.md.
#include <cmath>
#include <memory>
#include <numeric>
#include <random>

#include <CLI/CLI.hpp>

#include "engine/core/error.h"
#include "engine/graph/runner.h"
#include "passes/specular/fuse_estimates.h"
#include "passes/specular/hemi_images.h"
#include "passes/specular/run_network.h"
#include "shared/specular/hemi_images.h"
#include "tools/bench/filled_records.h"
#include "tools/bench/network_format.h"
#include "tools/bench/processor_time.h"
#include "tools/bench/random_network.h"
#include "tools/bench/subjects.h"

namespace patina::bench {
namespace hemi_bench {
namespace {

struct Options {
    std::vector<uint32_t> segments{1, 8, 64};
    uint32_t voxels = 256;
    std::string format;  ///< a key of kNetworkFormats; empty: what suits the device
};

/// Voxels of `segments` segments, each seen from random directions.
std::vector<FilledRecord> random_records(uint32_t segments, uint32_t voxels, float voxel_m) {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> angle(0, 6.283f), cosine(0.1f, 1), level(0.1f, 0.6f);
    std::vector<FilledRecord> records;
    for (uint32_t i = 0; i < segments * voxels; ++i) {
        const glm::vec2 at = (glm::vec2(i % 128, i / 128) - 64.0f) * voxel_m;
        FilledRecord record{{at.x, 0.3f * voxel_m, at.y}, {0, -1, 0}, 1 + i / voxels, {}};
        for (uint32_t k = 0; k < gpu::kMaxObservations; ++k) {
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
class Bench {
  public:
    Bench(vulkan::Device& device, const Options& options, uint32_t segments)
        : segments_(segments),
          map_(device, {.capacity_blocks = 64, .capacity_records = segments * options.voxels}),
          samples_(device, segments + 1),
          estimates_(device, segments + 1),
          network_(device, random_hemi_network(1)),
          variant_(named_variant(device.caps(), network_, segments, options.format)),
          runner_(device) {
        graph::FrameGraph frame = runner_.begin();
        map_.reset(frame, glm::dvec3(0));
        estimates_.reset(frame);
        runner_.submit(std::move(frame));
        frame = runner_.begin();
        ObservationMapIds ids = map_.import(frame);
        add_fill_records(frame, map_, ids, random_records(segments, options.voxels, map_.settings().voxel_m));
        ObservationMap::keep(frame, ids);
        fill_samples(frame, options.voxels);
        runner_.submit(std::move(frame));
    }

    void estimate() {
        runner_.wait();
        graph::FrameGraph frame = runner_.begin();
        std::vector<uint32_t> list(1 + segments_);
        std::iota(list.begin(), list.end(), 0u);
        list[0] = segments_;
        const SegmentBatch batch{frame.upload<uint32_t>("batch", list), segments_};
        const HemiImages images = add_hemi_images(frame, map_, map_.import(frame), samples_, samples_.import(frame),
                                                  batch, HemisphereMap::kParabolic, seed_++);
        const graph::BufferId estimates = add_run_network(frame, network_, images.images, batch, variant_);
        SpecularEstimateIds ids = estimates_.import(frame);
        add_fuse_estimates(frame, batch, estimates, images.drawn, estimates_, ids);
        SpecularEstimates::keep(frame, ids);
        runner_.submit(std::move(frame));
        runner_.wait();
    }

    NetworkFormat format() const { return variant_.format; }
    graph::Runner& runner() { return runner_; }

  private:
    void fill_samples(graph::FrameGraph& frame, uint32_t voxels) {
        std::vector<std::vector<uint32_t>> kept(segments_ + 1, std::vector<uint32_t>(voxels));
        kept[0].clear();
        for (uint32_t label = 1; label <= segments_; ++label)
            std::iota(kept[label].begin(), kept[label].end(), (label - 1) * voxels);
        add_keep_records(frame, samples_, kept);
    }

    uint32_t segments_, seed_ = 0;
    ObservationMap map_;
    SegmentSamples samples_;
    SpecularEstimates estimates_;
    Network network_;
    NetworkVariant variant_;
    graph::Runner runner_;
};

void add_row(Report& report, nlohmann::ordered_json& json, const Row& row, uint32_t segments) {
    const auto& [name, ms] = row;
    report.print("{:<36} {:>10.4f} {:>10.4f} {:>10.4f} {:>10.4f}\n", name, ms.min, ms.median, ms.p90,
                 ms.median / static_cast<float>(segments));
    json[name] = to_json(ms);
}

void measure(vulkan::Device& device, const Options& options, const Conditions& conditions, uint32_t segments,
             Report& report) {
    Bench bench(device, options, segments);
    for (uint32_t i = 0; i < conditions.warmup; ++i) bench.estimate();
    bench.runner().clear_timings();
    std::vector<float> processor;
    for (uint32_t i = 0; i < conditions.frames; ++i) {
        const double start = processor_ms();
        bench.estimate();
        processor.push_back(static_cast<float>(processor_ms() - start) / 2);
    }
    report.print("\n{} segments, {}, {} frames\n", segments, name_of(bench.format()), conditions.frames);
    report.print("{:<36} {:>10} {:>10} {:>10} {:>10}\n", "ms", "min", "median", "90 %", "a segment");
    nlohmann::ordered_json ms;
    float sum = 0;
    for (const graph::Timing& timing : bench.runner().pass_timings()) {
        const Row row{timing.name, distribution(timing.samples_ms)};
        add_row(report, ms, row, segments);
        sum += row.ms.median;
    }
    add_row(report, ms, {"sum of medians", {conditions.frames, sum, sum, sum}}, segments);
    add_row(report, ms, {"processor time on two cores", distribution(processor)}, segments);
    report.json["batches"].push_back({{"segments", segments}, {"format", name_of(bench.format())}, {"ms", ms}});
}

Report run(const Options& options, const Conditions& conditions) {
    vulkan::Device device(conditions.device);
    Report report(device.caps());
    for (const uint32_t segments : options.segments) measure(device, options, conditions, segments, report);
    return report;
}

}  // namespace
}  // namespace hemi_bench

Subject hemi_subject() {
    using namespace hemi_bench;
    return {"hemi",
            "How long specular materials take to estimate, on segments that are made up",
            {.warmup = 2, .frames = 15},
            [](CLI::App& app) -> Measure {
                const auto options = std::make_shared<Options>();
                app.add_option("--segments", options->segments, "Segments of a batch, one or several")
                    ->capture_default_str();
                app.add_option("--voxels", options->voxels, "That each of them keeps")
                    ->capture_default_str()
                    ->check(CLI::Range(1u, gpu::kSegmentSamples));
                app.add_option("--format", options->format, "Of activations and weights: floats, texels or halves")
                    ->check(CLI::IsMember(kNetworkFormats));
                return [options](const Conditions& conditions) { return run(*options, conditions); };
            }};
}

}  // namespace patina::bench
