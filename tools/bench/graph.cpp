// `patina bench graph`: what a frame costs the host. See docs/develop/benchmarks.md.
#include <chrono>
#include <memory>

#include <CLI/CLI.hpp>

#include "engine/core/error.h"
#include "engine/graph/runner.h"
#include "shared/test/test_saxpy.h"
#include "spirv/shaders.h"
#include "tools/bench/subjects.h"

namespace patina::bench {
namespace graph_bench {
namespace {

using Clock = std::chrono::steady_clock;

constexpr uint32_t kItems = 64;  // one group per dispatch

struct Options {
    uint32_t passes = 40;
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
void declare(graph::FrameGraph& frame, const vulkan::BufferRef& sums, uint32_t passes) {
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

Figures measure(vulkan::Device& device, const Options& options, const Conditions& conditions) {
    graph::Runner runner(device);
    const auto sums = device.create_buffer({"sums", kItems * sizeof(float)});
    graph::FrameGraph reset = runner.begin();
    reset.keep(reset.fill(reset.import(sums), 0));
    runner.submit(std::move(reset));

    std::vector<float> declare_ms, total_ms, compile_ms;
    for (uint32_t i = 0; i < conditions.warmup + conditions.frames; ++i) {
        // On a software device a frame in flight would compete with the host's work on the next one.
        runner.wait();
        if (i == conditions.warmup) runner.clear_timings();
        graph::FrameGraph frame = runner.begin();
        const auto start = Clock::now();
        declare(frame, sums, options.passes);
        const float declared_ms = milliseconds_since(start);
        runner.submit(std::move(frame));
        const float submitted_ms = milliseconds_since(start);
        if (i < conditions.warmup) continue;
        declare_ms.push_back(declared_ms);
        total_ms.push_back(submitted_ms);
    }
    runner.wait();
    const std::vector<float> submit_ms = runner.host_timing().samples_ms;
    for (uint32_t i = 0; i < conditions.frames; ++i) {
        const auto start = Clock::now();
        const graph::Plan plan = graph::compile(runner.last_frame().description);
        compile_ms.push_back(milliseconds_since(start));
        if (plan != runner.last_frame().plan) throw Error("one description compiled to two plans");
    }
    return {distribution(declare_ms), distribution(submit_ms), distribution(total_ms), distribution(compile_ms)};
}

Report run(const Options& options, const Conditions& conditions) {
    vulkan::Device device(conditions.device);
    const Figures figures = measure(device, options, conditions);
    Report report(device.caps());
    report.print("{} passes, {} frames\n\n", options.passes, conditions.frames);
    report.json["passes"] = options.passes;
    report.table("host ms per frame", {{"declare", figures.declare_ms},
                                       {"submit, shape seen before", figures.submit_ms},
                                       {"declare and submit", figures.total_ms},
                                       {"compile, new shapes only", figures.compile_ms}});
    return report;
}

}  // namespace
}  // namespace graph_bench

Subject graph_subject() {
    using namespace graph_bench;
    return {"graph",
            "What a frame of the render graph costs the host",
            {.warmup = 20, .frames = 500},
            [](CLI::App& app) -> Measure {
                const auto options = std::make_shared<Options>();
                app.add_option("--passes", options->passes, "Compute passes in a frame")
                    ->capture_default_str()
                    ->check(CLI::Range(1, 200));
                return [options](const Conditions& conditions) { return run(*options, conditions); };
            }};
}

}  // namespace patina::bench
