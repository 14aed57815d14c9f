#include "passes/segmentation/count_overlaps.h"

#include <map>
#include <random>

#include <glm/gtc/packing.hpp>

#include "engine/core/shader_camera.h"
#include "tests/gpu/gpu_test.h"
#include "tests/gpu/input/input_pictures.h"

namespace patina::count_overlaps_test {
namespace {

class CountOverlaps : public GpuTest {
  protected:
    using Counts = std::map<std::pair<uint32_t, uint32_t>, uint32_t>;  ///< pixels by segment and label

    struct Result {
        Counts counts;
        bool overflow = false;
        std::vector<gpu::SegmentLabel> labels;
    };

    /// `label`: of every kStride-th pixel in x and y; `segment`: of every `stride`-th.
    Result count(Extent2D extent, const Image<uint32_t>& segment, const Image<uint32_t>& label,
                 glm::vec4 color = {0, 0, 0, 0}, uint32_t stride = 1) {
        SegmentTable table(device(), 65535);
        graph::FrameGraph frame = runner().begin();
        table.reset(frame);
        run(std::move(frame));
        frame = runner().begin();
        SegmentTableIds ids = table.import(frame);
        const auto upload = [&](const char* name, vulkan::Format format, const auto& pixels) {
            return frame.upload(name, {extent, format}, std::as_bytes(std::span(pixels)));
        };
        const auto sampled =
            frame.upload("label", {label.extent(), vulkan::Format::kR32u}, std::as_bytes(std::span(label.pixels())));
        gpu::SegmentationParams values{};
        values.color_camera = make_camera(pinhole_camera(extent), RigidTransform(1.0));
        values.extent = {extent.width, extent.height};
        values.stamp = 4;
        values.overlap_slots = overlap_slots(extent);
        const auto params = frame.upload<gpu::SegmentationParams>("params", std::span(&values, 1));
        const std::vector<glm::vec4> points(extent.area(), glm::vec4(0, 0, 1, 1));
        const std::vector<uint64_t> colors(extent.area(), glm::packHalf4x16(color));
        const FrameSegments segments{frame.upload("segment", {segment.extent(), vulkan::Format::kR32u},
                                                  std::as_bytes(std::span(segment.pixels()))),
                                     {},
                                     {},
                                     stride};
        const SegmentOverlaps overlaps =
            add_count_overlaps(frame, ids, segments, sampled, upload("points", vulkan::Format::kRgba32f, points),
                               upload("color", vulkan::Format::kRgba16f, colors), params);
        const graph::Readback read_table = frame.read_back(overlaps.table), read_list = frame.read_back(overlaps.list),
                              read_labels = frame.read_back(ids.labels);
        run(std::move(frame));
        const auto entries = read_table.as<gpu::SegmentOverlap>();
        const auto list = read_list.as<uint32_t>();
        Result result{{}, list[0] >= values.overlap_slots / 4 * 3, read_labels.as<gpu::SegmentLabel>()};
        for (uint32_t i = 0; i < list[0] && !result.overflow; ++i) {
            const gpu::SegmentOverlap entry = entries[list[1 + i]];
            result.counts[{entry.key >> 16, entry.key & 0xffff}] += entry.pixels;
        }
        return result;
    }
};

constexpr uint32_t kStride = gpu::kSampleStride;

Extent2D sampled(Extent2D extent) { return sampled_extent(extent, kStride); }

class CountOverlapsAtStride : public CountOverlaps, public ::testing::WithParamInterface<uint32_t> {};

TEST_P(CountOverlapsAtStride, CountsEverySampleOnceOnWholeStripsAndTails) {
    std::mt19937 random(2);
    for (const Extent2D extent : {Extent2D{1, 1}, {8, 4}, {13, 7}, {259, 33}}) {
        const uint32_t stride = GetParam();
        Image<uint32_t> segment(sampled_extent(extent, stride)), label(sampled(extent));
        Counts expected;
        for (uint32_t y = 0; y < segment.extent().height; ++y) {
            for (uint32_t x = 0; x < segment.extent().width; ++x)
                segment.at(x, y) = (x / 5 + y / 3) % 4;  // runs, and no segment
        }
        for (uint32_t y = 0; y < label.extent().height; ++y) {
            for (uint32_t x = 0; x < label.extent().width; ++x) {
                label.at(x, y) = random() % 8 == 0 ? 65534 : x / 11 % 3;
                const uint32_t here = segment.at(kStride * x / stride, kStride * y / stride);
                if (here != 0 && label.at(x, y) != 0) expected[{here, label.at(x, y)}] += kStride * kStride;
            }
        }
        EXPECT_EQ(count(extent, segment, label, {}, stride).counts, expected) << extent;
    }
}
INSTANTIATE_TEST_SUITE_P(Strides, CountOverlapsAtStride, ::testing::Values(1u, 2u));

TEST_F(CountOverlaps, ATableThatIsTooSmallSaysSo) {
    const Extent2D extent{128, 64};
    Image<uint32_t> segment(extent, 1), label(sampled(extent));
    for (uint32_t i = 0; i < 767; ++i) label.pixels()[i] = i + 1;
    EXPECT_FALSE(count(extent, segment, label).overflow);
    for (uint32_t i = 0; i < label.pixels().size(); ++i) label.pixels()[i] = i + 1;
    EXPECT_TRUE(count(extent, segment, label).overflow);
}

TEST_F(CountOverlaps, CollectsTheChromaticityOfLabels) {
    const Extent2D extent{128, 64};
    const Image<uint32_t> segment(extent, 1), label(sampled(extent), 5);
    const gpu::SegmentLabel seen = count(extent, segment, label, {0.6f, 0.3f, 0.1f, 1.0f}).labels[5];
    EXPECT_EQ(seen.chroma_samples, label.pixels().size() / gpu::kStripPixels / 4);
    EXPECT_NEAR(double(seen.chroma_r) / seen.chroma_samples, 0.6 * gpu::kChromaSteps, 1);
    EXPECT_NEAR(double(seen.chroma_g) / seen.chroma_samples, 0.3 * gpu::kChromaSteps, 1);
    EXPECT_EQ(count(extent, segment, label, {0.6f, 0.3f, 0.1f, 0.5f}).labels[5].chroma_samples, 0u) << "clipped";
}

}  // namespace
}  // namespace patina::count_overlaps_test
