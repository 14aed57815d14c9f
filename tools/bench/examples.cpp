// `patina bench examples`: how far specular materials are from the truth on examples as the network is trained with: of
// the network, of the Ward fit, of both, and of the constant that does best. See docs/guide/training.md.
#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>

#include <CLI/CLI.hpp>
#include <glm/gtc/packing.hpp>

#include "passes/specular/run_network.h"
#include "reconstruction/session/network_file.h"
#include "tools/bench/example_fit.h"
#include "tools/bench/network_format.h"
#include "tools/bench/subjects.h"

namespace patina::bench {
namespace examples_bench {
namespace {

constexpr uint32_t kBatch = 64;     // scenes, as `patina synth-hemi` draws them
constexpr double kLeastKs = 0.02;   // below it there is nothing that a roughness could show in
constexpr float kConfident = 0.5f;  // of the fit

struct Options {
    std::string network;
    std::string format;  ///< a key of kNetworkFormats; empty: what suits the device
    uint64_t seed = 1000001;
    uint32_t examples = 4096;
    uint32_t fits = 8;
};

/// What became of one example.
struct Outcome {
    WardParameters truth, network;
    std::optional<WardParameters> fit{}, both{};  ///< where only lamps light it
    float confidence = 0;                         ///< of `fit`
};

/// The network on a batch's images.
class NetworkRun {
  public:
    NetworkRun(vulkan::Device& device, const Options& options)
        : network_(device, patina::read_network_file(options.network)),
          variant_(named_variant(device.caps(), network_, kBatch, options.format)),
          runner_(device) {}

    HemisphereMap map() const { return network_.description().map; }
    NetworkFormat format() const { return variant_.format; }

    std::vector<WardParameters> estimate(const ExampleBatch& batch) {
        std::vector<uint32_t> list(1 + kBatch);
        list[0] = kBatch;
        graph::FrameGraph frame = runner_.begin();
        const SegmentBatch segments{frame.upload<uint32_t>("examples.batch", list), kBatch};
        const graph::BufferId images = frame.upload<glm::vec4>("examples.images", images_of(batch));
        const graph::Readback w = frame.read_back(add_run_network(frame, network_, images, segments, variant_));
        runner_.submit(std::move(frame));
        runner_.wait();
        std::vector<WardParameters> result;
        for (const gpu::PerceptualMaterial& material : w.as<gpu::PerceptualMaterial>()) {
            const glm::dvec4 a(material.lab_cr), b(material.cgb_d_weight);
            result.push_back(ward_of({a.x, a.y, a.z, a.w, b.x, b.y, b.z}));
        }
        result.resize(kBatch);
        return result;
    }

  private:
    static std::vector<glm::vec4> images_of(const ExampleBatch& batch) {
        constexpr size_t kValues = size_t{3} * gpu::kHemiSamples * gpu::kHemiPixels;
        std::vector<glm::vec4> images(size_t{kBatch} * gpu::kHemiSamples * gpu::kHemiPixels, glm::vec4(0));
        for (size_t i = 0; i < kBatch * kValues; ++i) {
            const uint16_t half = batch.halves[i / kValues * gpu::kExampleHalves + i % kValues];
            images[i / 3][static_cast<int>(i % 3)] = glm::unpackHalf1x16(half);
        }
        return images;
    }

    Network network_;
    NetworkVariant variant_;
    graph::Runner runner_;
};

WardParameters gloss_of(const gpu::WardFit& fit) {
    return {glm::dvec3(0), glm::dvec3(fit.ks_alpha), double{fit.ks_alpha.w}};
}

void add_outcomes(const ExampleBatch& batch, NetworkRun& network, ExampleFit& fit, const Options& options,
                  std::vector<Outcome>& outcomes) {
    const std::vector<WardParameters> said = network.estimate(batch);
    const std::vector<gpu::WardFit> alone = fit.fit(batch, {}, options.fits);
    const std::vector<gpu::WardFit> with_network = fit.fit(batch, said, options.fits);
    for (size_t i = 0; i < kBatch && outcomes.size() < options.examples; ++i) {
        if (!batch.is_example(i)) continue;
        const glm::dvec4 truth(batch.scenes[i].materials.front().ks_alpha);
        Outcome outcome{{glm::dvec3(0), glm::dvec3(truth), truth.w}, said[i]};
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
void add_row(Report& report, const std::string& name, const std::vector<const Outcome*>& outcomes,
             const std::function<WardParameters(const Outcome&)>& estimate) {
    double ks = 0, alpha = 0;
    size_t glossy = 0;
    for (const Outcome* outcome : outcomes) {
        const WardParameters found = estimate(*outcome);
        ks += mean_of(glm::abs(found.ks - outcome->truth.ks));
        if (mean_of(outcome->truth.ks) < kLeastKs) continue;
        alpha += std::abs(found.alpha - outcome->truth.alpha);
        ++glossy;
    }
    ks /= static_cast<double>(outcomes.size());
    alpha /= static_cast<double>(glossy);  // no number where none is glossy
    const std::string alpha_error = glossy == 0 ? "-" : fmt::format("{:.4f}", alpha);
    report.print("{:<32} {:>8.4f} {:>8} {:>9}\n", name, ks, alpha_error, outcomes.size());
    nlohmann::ordered_json& row = report.json["mean_absolute_error"][name];
    row = {{"ks", ks}, {"examples", outcomes.size()}};
    if (glossy > 0) row["alpha"] = alpha;
}

double median(std::vector<double> values) {
    if (values.empty()) return 0;
    const auto middle = values.begin() + static_cast<ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

/// The constant with the least mean absolute error.
WardParameters constant_of(const std::vector<const Outcome*>& outcomes) {
    WardParameters result;
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

void add_table(Report& report, const std::vector<Outcome>& outcomes) {
    std::vector<const Outcome*> all, lamps, confident, doubtful;
    for (const Outcome& outcome : outcomes) {
        all.push_back(&outcome);
        if (!outcome.fit) continue;
        lamps.push_back(&outcome);
        (outcome.confidence >= kConfident ? confident : doubtful).push_back(&outcome);
    }
    report.print("{:<32} {:>8} {:>8} {:>9}\n", "mean absolute error", "ks", "alpha", "examples");
    const auto table = [&report](const std::string& name, const std::vector<const Outcome*>& some, bool fitted) {
        if (some.empty()) return;
        const WardParameters constant = constant_of(some);
        add_row(report, name + ", a constant", some, [&](const Outcome&) { return constant; });
        add_row(report, name + ", network", some, [](const Outcome& o) { return o.network; });
        if (!fitted) return;
        add_row(report, name + ", fit", some, [](const Outcome& o) { return *o.fit; });
        add_row(report, name + ", both", some, [](const Outcome& o) { return *o.both; });
    };
    table("all", all, false);
    table("lamps", lamps, true);
    table("lamps, fit sure", confident, true);
    table("lamps, fit unsure", doubtful, true);
}

std::vector<scenes::ExampleScene> draw(uint64_t seed, uint64_t first) {
    std::vector<scenes::ExampleScene> scenes;
    for (uint64_t i = 0; i < kBatch; ++i) scenes.push_back(scenes::draw_example_scene(seed, first + i));
    return scenes;
}

Report run(const Options& options, const Conditions& conditions) {
    vulkan::Device device(conditions.device);
    NetworkRun network(device, options);
    tools::ExampleRenderer renderer(device, kBatch, network.map(), true);
    ExampleFit fit(device, kBatch);
    std::vector<Outcome> outcomes;
    for (uint64_t first = 0; outcomes.size() < options.examples; first += kBatch) {
        const ExampleBatch batch = render_examples(renderer, options.seed, first, draw(options.seed, first));
        add_outcomes(batch, network, fit, options, outcomes);
    }
    Report report(device.caps());
    report.print("the network in {}\n", name_of(network.format()));
    report.json["format"] = name_of(network.format());
    add_table(report, outcomes);
    return report;
}

}  // namespace
}  // namespace examples_bench

Subject examples_subject() {
    using namespace examples_bench;
    return {"examples",
            "How far materials of held-out examples are from the truth: of the network, of the fit, and of both",
            {},
            [](CLI::App& app) -> Measure {
                const auto options = std::make_shared<Options>();
                app.add_option("--network", options->network, "Weight file")->required();
                app.add_option("--format", options->format,
                               "Of the network's activations and weights: floats, texels or halves")
                    ->check(CLI::IsMember(kNetworkFormats));
                app.add_option("--seed", options->seed,
                               "Of the examples; the default is that of those held out of the training")
                    ->capture_default_str();
                app.add_option("--examples", options->examples, "How many")
                    ->capture_default_str()
                    ->check(CLI::PositiveNumber);
                app.add_option("--fits", options->fits, "How often each is fitted; each is told by the one before")
                    ->capture_default_str()
                    ->check(CLI::PositiveNumber);
                return [options](const Conditions& conditions) { return run(*options, conditions); };
            }};
}

}  // namespace patina::bench
