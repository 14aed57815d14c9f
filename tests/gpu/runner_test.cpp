#include "engine/graph/runner.h"

#include <numeric>

#include <malloc.h>

#include "shared/test_saxpy.h"
#include "spirv/shaders.h"
#include "tests/gpu/gpu_test.h"

namespace patina {
namespace {

using RunnerTest = GpuTest;

TEST_F(RunnerTest, UploadsComputesAndReadsBack) {
    for (const uint32_t count : {1u, 63u, 64u, 65u, 1000u}) {
        std::vector<float> x(count), y(count, 1.0f);
        std::iota(x.begin(), x.end(), 0.0f);
        graph::Frame frame = runner().begin();
        const auto x_id = frame.upload<float>("x", x);
        auto y_id = frame.upload<float>("y", y);
        auto pass = frame.compute("test.saxpy", spirv::test_saxpy);
        pass.read("X", x_id).specialise("kRepeat", 2).push(gpu::SaxpyParams{3.0f, count});
        y_id = pass.modify("Y", y_id);
        pass.dispatch_covering(count);
        const graph::Readback result = frame.read_back(y_id, 0, count * sizeof(float));
        EXPECT_FALSE(result.ready());
        run(std::move(frame));
        const auto got = result.as<float>();
        ASSERT_EQ(got.size(), count);
        for (uint32_t i = 0; i < count; ++i) EXPECT_EQ(got[i], 1.0f + 6.0f * static_cast<float>(i));
    }
}

TEST_F(RunnerTest, FramesOfOneShapeAreCompiledOnce) {
    const auto persistent = device().create_buffer({"persistent", 64 * sizeof(float)});
    for (int i = 0; i < 5; ++i) {
        graph::Frame frame = runner().begin();
        auto y = frame.import(persistent);
        if (i == 0) {
            frame.keep(frame.fill(y, 0));
        } else {
            const std::vector<float> x(64, static_cast<float>(i));
            const auto x_id = frame.upload<float>("x", x);
            auto pass = frame.compute("test.saxpy", spirv::test_saxpy);
            pass.read("X", x_id).push(gpu::SaxpyParams{1.0f, 64});
            y = pass.modify("Y", y);
            pass.dispatch_covering(64u);
            frame.keep(y);
        }
        run(std::move(frame));
    }
    EXPECT_EQ(runner().compilations(), 2u);
    graph::Frame frame = runner().begin();
    const auto result = frame.read_back(frame.import(persistent));
    run(std::move(frame));
    EXPECT_EQ(result.as<float>(), std::vector<float>(64, 1 + 2 + 3 + 4));
}

TEST_F(RunnerTest, ImagesOfOneSizeInMemoryButAnotherShapeAreAnotherShape) {
    for (const Extent2D extent : {Extent2D{8, 8}, {13, 7}, {7, 13}, {8, 8}}) {
        std::vector<float> pixels(extent.area());
        std::iota(pixels.begin(), pixels.end(), 0.0f);
        graph::Frame frame = runner().begin();
        const auto result =
            frame.read_back(frame.upload("image", {extent, vulkan::Format::kR32f}, std::as_bytes(std::span(pixels))));
        run(std::move(frame));
        EXPECT_EQ(result.as<float>(), pixels) << extent;
    }
    EXPECT_EQ(runner().compilations(), 3u);
}

TEST_F(RunnerTest, ImagesReadBackKnowTheirExtents) {
    // Each read-back adds resources to the frame, whose list moves as it grows: freed memory is filled, so that whoever
    // still looks there sees it. Sanitizers look after that themselves.
    mallopt(M_PERTURB, 0xa5);
    graph::Frame frame = runner().begin();
    std::vector<graph::Readback> results;
    for (uint32_t i = 0; i < 40; ++i) {
        const std::vector<float> pixels((i + 1) * (i + 2), static_cast<float>(i));
        results.push_back(frame.read_back(
            frame.upload("image", {{i + 1, i + 2}, vulkan::Format::kR32f}, std::as_bytes(std::span(pixels)))));
    }
    run(std::move(frame));
    mallopt(M_PERTURB, 0);
    for (uint32_t i = 0; i < 40; ++i) {
        const Image<float> image = results[i].image<float>();
        EXPECT_EQ(image.extent(), (Extent2D{i + 1, i + 2}));
        EXPECT_EQ(image.pixels(), std::vector<float>((i + 1) * (i + 2), static_cast<float>(i)));
    }
}

TEST_F(RunnerTest, FramesThatMemoryRefusesLeaveNothingToTheNext) {
    vulkan::DeviceOptions options;
    options.selector = device().caps().name;
    for (options.fail_allocation_at = 1; options.fail_allocation_at < 100; ++options.fail_allocation_at) {
        vulkan::Device scarce(options);
        graph::Runner scarce_runner(scarce);
        graph::Readback small, large;
        try {
            graph::Frame frame = scarce_runner.begin();
            small = frame.read_back(frame.fill(frame.create_buffer("small", 64), 1));
            large = frame.read_back(frame.fill(frame.create_buffer("large", 8u << 20), 2));  // needs memory of its own
            scarce_runner.submit(std::move(frame));
            break;
        } catch (const Error&) {
        }
        const std::vector<float> values{1, 2, 3, 4};
        graph::Frame frame = scarce_runner.begin();
        const graph::Readback next = frame.read_back(frame.upload<float>("values", values));
        scarce_runner.submit(std::move(frame));
        scarce_runner.wait();
        EXPECT_EQ(next.as<float>(), values);
        EXPECT_FALSE(small.ready()) << options.fail_allocation_at;
        EXPECT_FALSE(large.ready()) << options.fail_allocation_at;
        for (const graph::Timing& timing : scarce_runner.pass_timings())
            EXPECT_THAT(timing.name, ::testing::HasSubstr("values")) << options.fail_allocation_at;
    }
    EXPECT_GT(options.fail_allocation_at, 3u) << "transient memory and two blocks of staging memory can be refused";
}

}  // namespace
}  // namespace patina
