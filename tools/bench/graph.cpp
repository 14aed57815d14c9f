// patina_graph_bench: what a frame costs the host. See docs/benchmarks.md.
#include <chrono>
#include <exception>
#include <fstream>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "engine/core/error.h"
#include "engine/graph/runner.h"
#include "shared/test_saxpy.h"
#include "spirv/shaders.h"
#include "tools/bench/distribution.h"
#include "tools/commands/commands.h"

namespace patina::bench {

namespace {

using Clock = std::chrono::steady_clock;

constexpr uint32_t kItems = 64;  // one group per dispatch

struct Options {
    tools::DeviceArguments device;
    uint32_t passes = 40;
    uint32_t frames = 500;
    uint32_t warmup = 20;
    std::filesystem::path json;
};

struct Figures {
    Distribution declare_ms;  ///< naming resources and passes
    Distribution submit_ms;   ///< of a shape seen before: find its plan, record, submit
    Distribution total_ms;    ///< both
    Distribution compile_ms;  ///< a new shape's plan, without its memory
};

float milliseconds_since(Clock::time_point start) {
    return std::chrono::duration<float, std::milli>(Clock::now() - start).count();
}

/// A chain of passes, each of which reads its predecessor's image and adds to a buffer that outlives the frame.
void declare(graph::Frame& frame, const vulkan::BufferRef& sums, uint32_t passes) {
    const graph::ImageShape shape{{kItems, 1}, vulkan::Format::kR32f};
    const gpu::SaxpyParams params{1.0f, kItems};
    const std::vector<float> x(kItems, 1.0f);
    const auto settings = frame.upload<gpu::SaxpyParams>("settings", std::span(&params, 1));
    const auto x_id = frame.upload<float>("x", x);
    graph::BufferId y = frame.import(sums);
    graph::ImageId image = frame.upload("first", shape, std::as_bytes(std::span(x)));
    for (uint32_t i = 0; i < passes; ++i) {
        auto pass = frame.compute("bench.link", spirv::test_bindings);
        pass.read("Settings", settings).read("X", x_id).read("source", image).push(params);
        y = pass.modify("Y", y);
        image = pass.create("target", shape);
        pass.dispatch_covering(kItems);
    }
    frame.keep(y);
}

Figures measure(vulkan::Device& device, const Options& options) {
    graph::Runner runner(device);
    const auto sums = device.create_buffer({"sums", kItems * sizeof(float)});
    graph::Frame reset = runner.begin();
    reset.keep(reset.fill(reset.import(sums), 0));
    runner.submit(std::move(reset));

    std::vector<float> declare_ms, total_ms, compile_ms;
    for (uint32_t i = 0; i < options.warmup + options.frames; ++i) {
        // On a software device a frame in flight would compete with the host's work on the next one.
        runner.wait();
        if (i == options.warmup) runner.clear_timings();
        graph::Frame frame = runner.begin();
        const auto start = Clock::now();
        declare(frame, sums, options.passes);
        const float declared_ms = milliseconds_since(start);
        runner.submit(std::move(frame));
        const float submitted_ms = milliseconds_since(start);
        if (i < options.warmup) continue;
        declare_ms.push_back(declared_ms);
        total_ms.push_back(submitted_ms);
    }
    runner.wait();
    const std::vector<float> submit_ms = runner.host_timing().samples_ms;
    for (uint32_t i = 0; i < options.frames; ++i) {
        const auto start = Clock::now();
        const graph::Plan plan = graph::compile(runner.last_frame().description);
        compile_ms.push_back(milliseconds_since(start));
        if (plan != runner.last_frame().plan) throw Error("one description compiled to two plans");
    }
    return {distribution(declare_ms), distribution(submit_ms), distribution(total_ms), distribution(compile_ms)};
}

void run(const Options& options) {
    vulkan::Device device(options.device.options());
    const Figures figures = measure(device, options);
    const std::pair<const char*, const Distribution*> rows[] = {{"declare", &figures.declare_ms},
                                                                {"submit, shape seen before", &figures.submit_ms},
                                                                {"declare and submit", &figures.total_ms},
                                                                {"compile, new shapes only", &figures.compile_ms}};
    fmt::print("{}, {}\n{} passes, {} frames\n\n", device.caps().name, device.caps().driver, options.passes,
               options.frames);
    fmt::print("{:<28} {:>9} {:>9} {:>9}\n", "host ms per frame", "min", "median", "90 %");
    nlohmann::ordered_json json{
        {"device", device.caps().name}, {"driver", device.caps().driver}, {"passes", options.passes}};
    for (const auto& [name, d] : rows) {
        fmt::print("{:<28} {:>9.4f} {:>9.4f} {:>9.4f}\n", name, d->min, d->median, d->p90);
        json["host_ms"][name] = {{"count", d->count}, {"min", d->min}, {"median", d->median}, {"p90", d->p90}};
    }
    if (options.json.empty()) return;
    std::ofstream out(options.json);
    out << json.dump(2) << '\n';
    if (!out.flush()) throw Error("the file '", options.json.string(), "' cannot be written");
}

}  // namespace

}  // namespace patina::bench

int main(int argc, char** argv) {
    using namespace patina;
    CLI::App app("Measures what a frame of the render graph costs the host", "patina_graph_bench");
    bench::Options options;
    app.add_option("--passes", options.passes, "Compute passes in a frame")
        ->capture_default_str()
        ->check(CLI::Range(1, 200));
    app.add_option("--frames", options.frames, "How many frames to measure")
        ->capture_default_str()
        ->check(CLI::PositiveNumber);
    app.add_option("--warmup", options.warmup, "How many frames to run before")->capture_default_str();
    app.add_option("--json", options.json, "Write the figures to this file");
    options.device.add_to(app);
    CLI11_PARSE(app, argc, argv);
    try {
        bench::run(options);
    } catch (const std::exception& error) {
        fmt::print(stderr, "patina_graph_bench: {}\n", error.what());
        return 1;
    }
    return 0;
}
