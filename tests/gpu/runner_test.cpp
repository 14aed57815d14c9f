#include "engine/graph/runner.h"

#include <numeric>

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

}  // namespace
}  // namespace patina
