#include "engine/graph/runner.h"

#include <numeric>

#include <malloc.h>

#include "shared/test/test_saxpy.h"
#include "spirv/shaders.h"
#include "tests/gpu/gpu_test.h"

namespace patina::runner_test {
namespace {

using RunnerTest = GpuTest;

TEST_F(RunnerTest, UploadsComputesAndReadsBack) {
    for (const uint32_t count : {1u, 63u, 64u, 65u, 1000u}) {
        std::vector<float> x(count), y(count, 1.0f);
        std::iota(x.begin(), x.end(), 0.0f);
        graph::FrameGraph frame = runner().begin();
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

TEST_F(RunnerTest, OnePixelOfAnImageIsReadBackAndTheFramesTimeIsKnownOnceItHasFinished) {
    const Extent2D extent{7, 5};
    std::vector<uint32_t> pixels(extent.area());
    std::iota(pixels.begin(), pixels.end(), 100u);
    graph::FrameGraph frame = runner().begin();
    const graph::ImageId image =
        frame.upload("image", {extent, vulkan::Format::kR32u}, std::as_bytes(std::span(pixels)));
    const graph::Readback first = frame.read_back_pixel(image, {0, 0}), last = frame.read_back_pixel(image, {6, 4}),
                          whole = frame.read_back(image);
    EXPECT_THROW(frame.read_back_pixel(image, {7, 0}), Error);
    const graph::FrameTime time = frame.time();
    EXPECT_FALSE(time.ms());
    run(std::move(frame));
    EXPECT_EQ(first.as<uint32_t>(), std::vector<uint32_t>{100});
    EXPECT_EQ(last.as<uint32_t>(), std::vector<uint32_t>{134});
    EXPECT_EQ(whole.as<uint32_t>(), pixels);
    EXPECT_EQ(time.ms().has_value(), device().caps().timestamps);
    EXPECT_GE(time.ms().value_or(0), 0);
}

TEST_F(RunnerTest, TheDeviceKnowsWhatMemoryItHolds) {
    const uint64_t before = device().held_memory();
    auto buffer = device().create_buffer({"held", 1u << 20});
    EXPECT_GE(device().held_memory(), before + (1u << 20));
    EXPECT_LT(device().held_memory(), before + (2u << 20));
    buffer.reset();
    EXPECT_EQ(device().held_memory(), before);
}

TEST_F(RunnerTest, FramesOfOneShapeAreCompiledOnce) {
    const auto persistent = device().create_buffer({"persistent", 64 * sizeof(float)});
    for (int i = 0; i < 5; ++i) {
        graph::FrameGraph frame = runner().begin();
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
    graph::FrameGraph frame = runner().begin();
    const auto result = frame.read_back(frame.import(persistent));
    run(std::move(frame));
    EXPECT_EQ(result.as<float>(), std::vector<float>(64, 1 + 2 + 3 + 4));
}

TEST_F(RunnerTest, ImagesOfOneSizeInMemoryButAnotherShapeAreAnotherShape) {
    for (const Extent2D extent : {Extent2D{8, 8}, {13, 7}, {7, 13}, {8, 8}}) {
        std::vector<float> pixels(extent.area());
        std::iota(pixels.begin(), pixels.end(), 0.0f);
        graph::FrameGraph frame = runner().begin();
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
    graph::FrameGraph frame = runner().begin();
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
            graph::FrameGraph frame = scarce_runner.begin();
            small = frame.read_back(frame.fill(frame.create_buffer("small", 64), 1));
            large = frame.read_back(frame.fill(frame.create_buffer("large", 8u << 20), 2));  // needs memory of its own
            scarce_runner.submit(std::move(frame));
            break;
        } catch (const Error&) {
        }
        const std::vector<float> values{1, 2, 3, 4};
        graph::FrameGraph frame = scarce_runner.begin();
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

/// Adds `factor` times 0, 1, 2 .. to `count` zeros, in transient buffers and, beside them, in a transient image.
struct Counted {
    graph::Readback sums, image;

    Counted(graph::Runner& runner, uint32_t count, float factor) {
        std::vector<float> x(count);
        std::iota(x.begin(), x.end(), 0.0f);
        graph::FrameGraph frame = runner.begin();
        const auto x_id = frame.upload<float>("x", x);
        auto y_id = frame.fill(frame.create_buffer("y", count * sizeof(float)), 0);
        auto pass = frame.compute("test.saxpy", spirv::test_saxpy);
        pass.read("X", x_id).push(gpu::SaxpyParams{factor, count});
        y_id = pass.modify("Y", y_id);
        pass.dispatch_covering(count);
        sums = frame.read_back(y_id, 0, count * sizeof(float));
        image =
            frame.read_back(frame.upload("image", {{count, 1}, vulkan::Format::kR32f}, std::as_bytes(std::span(x))));
        runner.submit(std::move(frame));
    }

    void expect(uint32_t count, float factor) const {
        std::vector<float> x(count);
        std::iota(x.begin(), x.end(), 0.0f);
        EXPECT_EQ(image.as<float>(), x);
        for (float& value : x) value *= factor;
        EXPECT_EQ(sums.as<float>(), x);
    }
};

TEST_F(RunnerTest, ShapesInFlightShareTheMemoryOfTheLargest) {
    graph::Runner largest(device());
    const Counted alone(largest, 4000, 2.0f);
    largest.wait();
    alone.expect(4000, 2.0f);

    // Grows twice while frames of the shape before are in flight, then alternates.
    const std::vector<uint32_t> counts{64, 1000, 64, 4000, 64, 4000, 1000, 64, 4000, 1000};
    std::vector<Counted> frames;
    for (size_t i = 0; i < counts.size(); ++i) frames.emplace_back(runner(), counts[i], static_cast<float>(i + 1));
    runner().wait();
    for (size_t i = 0; i < counts.size(); ++i) frames[i].expect(counts[i], static_cast<float>(i + 1));
    EXPECT_EQ(runner().compilations(), 3u);
    EXPECT_EQ(runner().transient_bytes(), largest.transient_bytes());
    EXPECT_GE(runner().transient_bytes(), 4000 * sizeof(float) * 2);

    runner().forget_shapes();
    EXPECT_EQ(runner().transient_bytes(), 0u);
    const Counted again(runner(), 64, 3.0f);
    runner().wait();
    again.expect(64, 3.0f);
    EXPECT_LT(runner().transient_bytes(), largest.transient_bytes());
}

TEST_F(RunnerTest, AShapeThatMemoryRefusesLeavesTheOthersUsable) {
    vulkan::DeviceOptions options;
    options.selector = device().caps().name;
    uint32_t refused = 0;
    for (options.fail_allocation_at = 1; options.fail_allocation_at < 100; ++options.fail_allocation_at) {
        vulkan::Device scarce(options);
        graph::Runner scarce_runner(scarce);
        try {
            const Counted small(scarce_runner, 64, 1.0f);
            const Counted large(scarce_runner, 4000, 1.0f);
            break;
        } catch (const Error&) {
            ++refused;
        }
        const Counted small(scarce_runner, 64, 5.0f);
        const Counted large(scarce_runner, 4000, 6.0f);
        scarce_runner.wait();
        small.expect(64, 5.0f);
        large.expect(4000, 6.0f);
    }
    EXPECT_GE(refused, 4u) << "two blocks of each shape can be refused";
}

TEST_F(RunnerTest, EveryPassOfALongFrameIsTimed) {
    if (!device().caps().timestamps) GTEST_SKIP() << "the device has no timestamps";
    for (const size_t passes : {3, 300, 2}) {
        runner().clear_timings();
        graph::FrameGraph frame = runner().begin();
        auto id = frame.fill(frame.create_buffer("words", 64), 0);
        const uint32_t word = 7;  // over a part each time, so that no pass makes the one before needless
        for (size_t i = 0; i < passes; ++i)
            id = frame.upload_bytes(id, 4 * (i % 16), std::as_bytes(std::span(&word, 1)), false);
        frame.read_back(id);
        run(std::move(frame));
        size_t timed = 0;
        for (const graph::Timing& timing : runner().pass_timings()) timed += timing.samples_ms.size();
        EXPECT_EQ(timed, passes + 2) << "with the fill and the read-back";
    }
}

TEST_F(RunnerTest, TransfersStayWithinTheirBuffer) {
    const std::vector<float> values(4);
    const auto bytes = std::as_bytes(std::span(values));
    const vulkan::BufferRef buffer = device().create_buffer({"small", 32}),
                            other = device().create_buffer({"other", 64});
    const auto error_of = [&](const auto& transfer) {
        graph::FrameGraph frame = runner().begin();
        try {
            transfer(frame, frame.import(buffer), frame.import(other));
        } catch (const Error& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    EXPECT_EQ(error_of([&](auto& frame, auto small, auto) { frame.upload_bytes(small, 20, bytes, false); }),
              "the upload to 'small' takes 16 bytes from byte 20, of 32");
    EXPECT_EQ(error_of([&](auto& frame, auto small, auto) { frame.read_back(small, UINT64_MAX, 4); }),
              "the read-back of 'small' takes 4 bytes from byte 18446744073709551615, of 32");
    EXPECT_EQ(error_of([&](auto& frame, auto small, auto large) { frame.copy(small, 0, large, 0, 36); }),
              "the copy from 'small' takes 36 bytes from byte 0, of 32");
    EXPECT_EQ(error_of([&](auto& frame, auto small, auto large) { frame.copy(large, 0, small, 4, 32); }),
              "the copy to 'small' takes 32 bytes from byte 4, of 32");
    EXPECT_EQ(error_of([&](auto& frame, auto small, auto large) { frame.copy(large, 32, small, 0, 32); }), "");
}

TEST_F(RunnerTest, TransfersKnowOneChunkAlone) {
    const vulkan::ChunkedBuffer chunked(device(), "chunked", 24, 4, 16, 4);
    const vulkan::BufferRef whole = device().create_buffer({"whole", 96});
    const std::vector<float> values(4);
    const auto expect_refused = [&](const std::string& transfer, const auto& do_it) {
        graph::FrameGraph frame = runner().begin();
        try {
            do_it(frame, frame.import(chunked), frame.import(whole));
            FAIL() << transfer;
        } catch (const Error& error) {
            EXPECT_EQ(error.what(), "the " + transfer + " 'chunked[0]' spans 2 chunks; it can have one alone");
        }
    };
    expect_refused("upload to", [&](auto& frame, auto chunks, auto) {
        frame.upload_bytes(chunks, 0, std::as_bytes(std::span(values)), false);
    });
    expect_refused("read-back of", [&](auto& frame, auto chunks, auto) { frame.read_back(chunks, 0, 16); });
    expect_refused("copy from", [&](auto& frame, auto chunks, auto one) { frame.copy(chunks, 0, one, 0, 16); });
    expect_refused("copy to", [&](auto& frame, auto chunks, auto one) { frame.copy(one, 0, chunks, 0, 16); });
}

}  // namespace
}  // namespace patina::runner_test
