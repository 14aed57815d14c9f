// patina_examples_bench: how far specular materials are from the truth on examples as the network is trained with: of
// the network, of the Ward fit, of both, and of the constant that does best. See docs/training.md.
#include <algorithm>
#include <cmath>
#include <exception>
#include <functional>
#include <map>
#include <numeric>
#include <optional>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <glm/gtc/packing.hpp>

#include "engine/core/error.h"
#include "engine/graph/runner.h"
#include "passes/model/lights.h"
#include "passes/specular/fit_ward.h"
#include "passes/specular/perceptual.h"
#include "passes/specular/run_network.h"
#include "shared/reflectance.h"
#include "tools/bench/filled_records.h"
#include "tools/commands/commands.h"
#include "tools/example_renderer.h"
#include "tools/network_file.h"

namespace patina::bench {

namespace {

constexpr uint32_t kBatch = 64;     // scenes, as `patina synth-hemi` draws them
constexpr double kLeastKs = 0.02;   // below it there is nothing that a roughness could show in
constexpr float kConfident = 0.5f;  // of the fit

const std::map<std::string, NetworkFormat> kFormats{{"floats", NetworkFormat::kFloats},
                                                    {"halves", NetworkFormat::kHalves}};

struct Options {
    tools::DeviceArguments device;
    std::string network;
    std::string format = "floats";
    uint64_t seed = 1000001;
    uint32_t examples = 4096;
    uint32_t fits = 8;
};

/// ks and alpha.
struct Gloss {
    glm::dvec3 ks{0};
    double alpha = 1;
};

/// What became of one example.
struct Outcome {
    Gloss truth, network;
    std::optional<Gloss> fit{}, both{};  ///< where only lamps light it
    float confidence = 0;                ///< of `fit`
};

/// What a batch of examples looks like.
struct Batch {
    std::vector<sensor::ExampleScene> scenes;
    std::vector<uint16_t> halves;
    std::vector<uint32_t> drawn;
    std::vector<gpu::ExampleReading> readings;
    std::vector<float> exposures;

    /// Voxels that were seen often enough, so that it is an example.
    bool is_example(size_t scene) const { return drawn[scene * gpu::kHemiSamples] != gpu::kNoRecord; }
    bool is_lit_by_lamps(size_t scene) const { return scenes[scene].scene.windows == 0; }
};

Batch render(tools::ExampleRenderer& renderer, uint64_t seed, uint64_t first) {
    Batch batch;
    for (uint64_t i = 0; i < kBatch; ++i) batch.scenes.push_back(sensor::draw_example_scene(seed, first + i));
    const tools::RenderedExamples rendered = renderer.submit(seed, first, batch.scenes);
    renderer.wait();
    batch.halves = rendered.halves.as<uint16_t>();
    batch.drawn = rendered.drawn.as<uint32_t>();
    batch.readings = rendered.readings.as<gpu::ExampleReading>();
    batch.exposures = rendered.exposures.as<float>();
    return batch;
}

/// What was read of a voxel: as many readings as a record keeps, evenly among them.
std::vector<FilledObservation> observations_of(const Batch& batch, size_t voxel) {
    std::vector<gpu::ExampleReading> seen;
    for (size_t view = 0; view < gpu::kExampleViews; ++view) {
        const gpu::ExampleReading& reading = batch.readings[view * kBatch * gpu::kExampleVoxels + voxel];
        if (reading.to_viewer.w != 0) seen.push_back(reading);
    }
    const size_t count = std::min<size_t>(seen.size(), gpu::kMaxObservations);
    std::vector<FilledObservation> observations;
    for (size_t i = 0; i < count; ++i) {
        const gpu::ExampleReading& reading = seen[i * seen.size() / count];
        const auto clipped = static_cast<uint32_t>(reading.rgb.w);
        observations.push_back({glm::vec3(reading.to_viewer),
                                glm::vec3(reading.rgb),
                                {(clipped & 1) != 0, (clipped & 2) != 0, (clipped & 4) != 0}});
    }
    return observations;
}

/// The network on a batch's images.
class NetworkRun {
  public:
    NetworkRun(vulkan::Device& device, const Options& options)
        : network_(device, tools::read_network_file(options.network)),
          variant_(preferred_network_variant(device.caps(), network_, kBatch)) {
        if (options.format == "halves" && !device.caps().float16) {
            throw Error("'", device.caps().name, "' cannot compute in 16-bit floats");
        }
        if (options.format == "halves" || variant_.format == NetworkFormat::kHalves) {
            variant_.format = kFormats.at(options.format);
        }
    }

    HemisphereMap map() const { return network_.description().map; }

    std::vector<Gloss> estimate(graph::Runner& runner, const Batch& batch) {
        std::vector<glm::vec4> images(size_t{kBatch} * gpu::kHemiSamples * gpu::kHemiPixels, glm::vec4(0));
        constexpr size_t kValues = size_t{3} * gpu::kHemiSamples * gpu::kHemiPixels;
        for (size_t i = 0; i < kBatch * kValues; ++i) {
            const size_t scene = i / kValues, value = i % kValues;
            images[i / 3][static_cast<int>(i % 3)] =
                glm::unpackHalf1x16(batch.halves[scene * gpu::kExampleHalves + value]);
        }
        std::vector<uint32_t> list(1 + kBatch);
        list[0] = kBatch;
        graph::Frame frame = runner.begin();
        const SegmentBatch segments{frame.upload<uint32_t>("examples.batch", list), kBatch};
        const graph::Readback w = frame.read_back(
            add_run_network(frame, network_, frame.upload<glm::vec4>("examples.images", images), segments, variant_));
        runner.submit(std::move(frame));
        runner.wait();
        std::vector<Gloss> result;
        for (const gpu::PerceptualMaterial& material : w.as<gpu::PerceptualMaterial>()) {
            const glm::dvec4 a(material.lab_cr), b(material.cgb_d_weight);
            const WardParameters ward = ward_of({a.x, a.y, a.z, a.w, b.x, b.y, b.z});
            result.push_back({ward.ks, ward.alpha});
        }
        result.resize(kBatch);
        return result;
    }

  private:
    Network network_;
    NetworkVariant variant_;
};

/// The Ward fit on a batch's scenes that lamps light, whose places and intensities it is told.
class FitRun {
  public:
    FitRun(vulkan::Device& device, uint32_t fits)
        : fits_(fits),
          map_(device,
               {.voxel_m = 0.005f, .block_m = 0.01f, .capacity_blocks = 64, .capacity_records = kBatch * kVoxels}),
          samples_(device, kBatch),
          table_(device, kBatch),
          runner_(device) {}

    /// Those of a batch's scenes, by scene; `network` tells alpha's prior where it is not empty.
    std::vector<gpu::WardFit> fit(const Batch& batch, const std::vector<Gloss>& network) {
        reset(batch);
        std::vector<gpu::WardMaterial> said(kBatch);
        for (size_t i = 0; i < network.size(); ++i) {
            said[i] = {glm::vec4(0.2f, 0.2f, 0.2f, 1), glm::vec4(network[i].ks, network[i].alpha)};
        }
        std::vector<gpu::WardFit> result;
        for (uint32_t i = 0; i < fits_; ++i) result = fit_once(batch, said);
        return result;
    }

  private:
    static constexpr uint32_t kVoxels = gpu::kExampleVoxels;

    void reset(const Batch& batch) {
        lights_.assign(kBatch, {});
        for (size_t i = 0; i < kBatch; ++i) {
            std::vector<PointLight> lamps;
            const sensor::ExampleScene& scene = batch.scenes[i];
            for (size_t k = 0; k < scene.scene.lamps; ++k) {
                const gpu::PointLight& lamp = scene.lamps[k];
                lamps.push_back({glm::vec3(lamp.position_m), glm::vec3(lamp.intensity) * batch.exposures[i]});
            }
            lights_[i].set(lamps);
        }
        graph::Frame frame = runner_.begin();
        map_.reset(frame, glm::dvec3(0));
        table_.reset(frame);
        runner_.submit(std::move(frame));
        frame = runner_.begin();
        ObservationMapIds ids = map_.import(frame);
        add_fill_records(frame, map_, ids, records_of(batch));
        ids.visibility = frame.upload_bytes(ids.visibility, 0, std::as_bytes(std::span(reached_)), true);
        ObservationMap::keep(frame, ids);
        std::vector<gpu::SegmentSampleCount> counts(kBatch);
        std::vector<uint32_t> kept(size_t{kBatch} * gpu::kSegmentSamples);
        for (uint32_t i = 0; i < kBatch; ++i) {
            counts[i].kept = counts[i].eligible = kVoxels;
            const auto first = kept.begin() + static_cast<ptrdiff_t>(i) * gpu::kSegmentSamples;
            std::iota(first, first + kVoxels, i * kVoxels);
        }
        SegmentSampleIds samples = samples_.import(frame);
        samples.counts = frame.upload_bytes(samples.counts, 0, std::as_bytes(std::span(counts)), true);
        samples.kept = frame.upload_bytes(samples.kept, 0, std::as_bytes(std::span(kept)), true);
        SegmentSamples::keep(frame, samples);
        runner_.submit(std::move(frame));
    }

    std::vector<FilledRecord> records_of(const Batch& batch) {
        std::vector<FilledRecord> records;
        reached_.clear();
        for (uint32_t i = 0; i < kBatch * kVoxels; ++i) {
            const gpu::ExampleVoxel& voxel = batch.scenes[i / kVoxels].voxels[i % kVoxels];
            records.push_back(
                {glm::vec3(voxel.point_m), glm::vec3(voxel.stored_normal), i / kVoxels, observations_of(batch, i)});
            reached_.emplace_back(~voxel.shadow, 0u);
        }
        return records;
    }

    std::vector<gpu::WardFit> fit_once(const Batch& batch, const std::vector<gpu::WardMaterial>& said) {
        graph::Frame frame = runner_.begin();
        const ObservationMapIds records = map_.import(frame);
        const SegmentSampleIds samples = samples_.import(frame);
        gpu::RecordStatus marched{};
        marched.marched = (lights_.front().position_version() % 255 + 1) << 24;  // lib/reflectance.glsl
        const std::vector<gpu::RecordStatus> status(kBatch * kVoxels, marched);
        const graph::BufferId status_id = frame.upload<gpu::RecordStatus>("examples.status", status);
        const graph::BufferId network = frame.upload<gpu::WardMaterial>("examples.network", said);
        graph::BufferId materials =
            frame.upload<gpu::SegmentMaterial>("examples.materials", std::vector<gpu::SegmentMaterial>(kBatch));
        WardFitIds ids = table_.import(frame);
        for (uint32_t i = 0; i < kBatch; ++i) {
            if (!batch.is_lit_by_lamps(i)) continue;
            const SegmentBatch one{frame.upload<uint32_t>("examples.label", std::vector<uint32_t>{1, i}), 1};
            add_fit_ward(frame,
                         {map_, records, status_id, lights_[i].upload(frame), lights_[i].position_version(), samples_,
                          samples, network, kBatch},
                         one, table_, ids, materials);
        }
        WardFits::keep(frame, ids);
        const graph::Readback fits = frame.read_back(ids.fits);
        runner_.submit(std::move(frame));
        runner_.wait();
        return fits.as<gpu::WardFit>();
    }

    uint32_t fits_;
    ObservationMap map_;
    SegmentSamples samples_;
    WardFits table_;
    graph::Runner runner_;
    std::vector<Lights> lights_;
    std::vector<glm::uvec2> reached_;  ///< a bit per lamp, by record
};

Gloss gloss_of(const gpu::WardFit& fit) { return {glm::dvec3(fit.ks_alpha), double{fit.ks_alpha.w}}; }

void add_outcomes(const Batch& batch, NetworkRun& network, FitRun& fit, graph::Runner& runner, uint32_t wanted,
                  std::vector<Outcome>& outcomes) {
    const std::vector<Gloss> said = network.estimate(runner, batch);
    const std::vector<gpu::WardFit> alone = fit.fit(batch, {}), with_network = fit.fit(batch, said);
    for (size_t i = 0; i < kBatch && outcomes.size() < wanted; ++i) {
        if (!batch.is_example(i)) continue;
        const glm::dvec4 truth(batch.scenes[i].materials.front().ks_alpha);
        Outcome outcome{{glm::dvec3(truth), truth.w}, said[i]};
        if (batch.is_lit_by_lamps(i)) {
            outcome.fit = gloss_of(alone[i]);
            outcome.both = gloss_of(with_network[i]);
            outcome.confidence = alone[i].confidence;
        }
        outcomes.push_back(outcome);
    }
}

double mean_of(glm::dvec3 v) { return (v.x + v.y + v.z) / 3; }

/// Mean absolute errors: ks per channel, alpha where ks is at least kLeastKs.
void print(const std::string& name, const std::vector<const Outcome*>& outcomes,
           const std::function<Gloss(const Outcome&)>& estimate) {
    double ks = 0, alpha = 0;
    size_t glossy = 0;
    for (const Outcome* outcome : outcomes) {
        const Gloss found = estimate(*outcome);
        ks += mean_of(glm::abs(found.ks - outcome->truth.ks));
        if (mean_of(outcome->truth.ks) < kLeastKs) continue;
        alpha += std::abs(found.alpha - outcome->truth.alpha);
        ++glossy;
    }
    const std::string alpha_error = glossy == 0 ? "-" : fmt::format("{:.4f}", alpha / static_cast<double>(glossy));
    fmt::print("{:<32} {:>8.4f} {:>8} {:>9}\n", name, ks / static_cast<double>(outcomes.size()), alpha_error,
               outcomes.size());
}

double median(std::vector<double> values) {
    if (values.empty()) return 0;
    const auto middle = values.begin() + static_cast<ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

/// The constant with the least mean absolute error.
Gloss constant_of(const std::vector<const Outcome*>& outcomes) {
    Gloss result;
    for (int c = 0; c < 3; ++c) {
        std::vector<double> values;
        for (const Outcome* outcome : outcomes) values.push_back(outcome->truth.ks[c]);
        result.ks[c] = median(values);
    }
    std::vector<double> alphas;
    for (const Outcome* outcome : outcomes) {
        if (mean_of(outcome->truth.ks) >= kLeastKs) alphas.push_back(outcome->truth.alpha);
    }
    result.alpha = median(alphas);
    return result;
}

void report(const std::vector<Outcome>& outcomes) {
    std::vector<const Outcome*> all, lamps, confident, doubtful;
    for (const Outcome& outcome : outcomes) {
        all.push_back(&outcome);
        if (!outcome.fit) continue;
        lamps.push_back(&outcome);
        (outcome.confidence >= kConfident ? confident : doubtful).push_back(&outcome);
    }
    fmt::print("{:<32} {:>8} {:>8} {:>9}\n", "mean absolute error", "ks", "alpha", "examples");
    const auto table = [](const std::string& name, const std::vector<const Outcome*>& some, bool fitted) {
        if (some.empty()) return;
        const Gloss constant = constant_of(some);
        print(name + ", a constant", some, [&](const Outcome&) { return constant; });
        print(name + ", network", some, [](const Outcome& o) { return o.network; });
        if (!fitted) return;
        print(name + ", fit", some, [](const Outcome& o) { return *o.fit; });
        print(name + ", both", some, [](const Outcome& o) { return *o.both; });
    };
    table("all", all, false);
    table("lamps", lamps, true);
    table("lamps, fit sure", confident, true);
    table("lamps, fit unsure", doubtful, true);
}

void run(vulkan::Device& device, const Options& options) {
    NetworkRun network(device, options);
    tools::ExampleRenderer renderer(device, kBatch, network.map(), true);
    FitRun fit(device, options.fits);
    graph::Runner runner(device);
    std::vector<Outcome> outcomes;
    for (uint64_t first = 0; outcomes.size() < options.examples; first += kBatch) {
        add_outcomes(render(renderer, options.seed, first), network, fit, runner, options.examples, outcomes);
    }
    report(outcomes);
}

}  // namespace

}  // namespace patina::bench

int main(int argc, char** argv) {
    using namespace patina;
    CLI::App app("Measures how far materials of held-out examples are from the truth", "patina_examples_bench");
    bench::Options options;
    app.add_option("--network", options.network, "Weight file")->required();
    app.add_option("--format", options.format, "Of the network's activations and weights: floats or halves")
        ->capture_default_str()
        ->check(CLI::IsMember(bench::kFormats));
    app.add_option("--seed", options.seed, "Of the examples; the default is that of those held out of the training")
        ->capture_default_str();
    app.add_option("--examples", options.examples, "How many")->capture_default_str()->check(CLI::PositiveNumber);
    app.add_option("--fits", options.fits, "How often each is fitted; each is told by the one before")
        ->capture_default_str()
        ->check(CLI::PositiveNumber);
    options.device.add_to(app);
    CLI11_PARSE(app, argc, argv);
    try {
        vulkan::Device device(options.device.options());
        fmt::print("{}, {}\n", device.caps().name, device.caps().driver);
        bench::run(device, options);
    } catch (const std::exception& error) {
        fmt::print(stderr, "patina_examples_bench: {}\n", error.what());
        return 1;
    }
    return 0;
}
