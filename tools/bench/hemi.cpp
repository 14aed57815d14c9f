// patina_hemi_bench: how long HemiImages, the network and the fusion of its estimates take, on segments that are made
// up. See docs/benchmarks.md.
#include <cmath>
#include <exception>
#include <numeric>
#include <random>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "engine/core/error.h"
#include "engine/graph/runner.h"
#include "passes/specular/fuse_estimates.h"
#include "passes/specular/hemi_images.h"
#include "passes/specular/run_network.h"
#include "shared/hemi_images.h"
#include "tools/bench/distribution.h"
#include "tools/bench/filled_records.h"
#include "tools/bench/network_format.h"
#include "tools/bench/processor_time.h"
#include "tools/bench/random_network.h"
#include "tools/commands/commands.h"

namespace patina::bench {

namespace {

struct Options {
    tools::DeviceArguments device;
    std::vector<uint32_t> segments{1, 8, 64};
    uint32_t voxels = 256;
    uint32_t frames = 15;
    uint32_t warmup = 2;
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
        graph::Frame frame = runner_.begin();
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
        graph::Frame frame = runner_.begin();
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
    void fill_samples(graph::Frame& frame, uint32_t voxels) {
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

void print(const std::string& name, const Distribution& d, uint32_t segments) {
    fmt::print("{:<34} {:>9.3f} {:>9.3f} {:>9.3f} {:>9.3f}\n", name, d.min, d.median, d.p90,
               d.median / static_cast<float>(segments));
}

void run(vulkan::Device& device, const Options& options, uint32_t segments) {
    Bench bench(device, options, segments);
    for (uint32_t i = 0; i < options.warmup; ++i) bench.estimate();
    bench.runner().clear_timings();
    std::vector<float> processor;
    for (uint32_t i = 0; i < options.frames; ++i) {
        const double start = processor_ms();
        bench.estimate();
        processor.push_back(static_cast<float>(processor_ms() - start) / 2);
    }
    fmt::print("\n{} segments, {}, {} frames\n", segments, name_of(bench.format()), options.frames);
    fmt::print("{:<34} {:>9} {:>9} {:>9} {:>9}\n", "ms", "min", "median", "90 %", "a segment");
    float sum = 0;
    for (const graph::Timing& timing : bench.runner().pass_timings()) {
        const Distribution ms = distribution(timing.samples_ms);
        print(timing.name, ms, segments);
        sum += ms.median;
    }
    print("sum of medians", {options.frames, sum, sum, sum}, segments);
    print("processor time on two cores", distribution(processor), segments);
}

}  // namespace

}  // namespace patina::bench

int main(int argc, char** argv) {
    using namespace patina;
    CLI::App app("Measures how long specular materials take to estimate", "patina_hemi_bench");
    bench::Options options;
    app.add_option("--segments", options.segments, "Segments of a batch, one or several")->capture_default_str();
    app.add_option("--voxels", options.voxels, "That each of them keeps")
        ->capture_default_str()
        ->check(CLI::Range(1u, gpu::kSegmentSamples));
    app.add_option("--frames", options.frames, "How many batches to measure")
        ->capture_default_str()
        ->check(CLI::PositiveNumber);
    app.add_option("--warmup", options.warmup, "How many to run before")->capture_default_str();
    app.add_option("--format", options.format, "Of activations and weights: floats, texels or halves")
        ->check(CLI::IsMember(bench::kNetworkFormats));
    options.device.add_to(app);
    CLI11_PARSE(app, argc, argv);
    try {
        vulkan::Device device(options.device.options());
        fmt::print("{}, {}\n", device.caps().name, device.caps().driver);
        for (const uint32_t segments : options.segments) bench::run(device, options, segments);
    } catch (const std::exception& error) {
        fmt::print(stderr, "patina_hemi_bench: {}\n", error.what());
        return 1;
    }
    return 0;
}
