#include "passes/segmentation/label_pixels.h"

#include "shared/segmentation/segments.h"
#include "tests/gpu/gpu_test.h"
#include "tests/gpu/input/input_pictures.h"
#include "tests/gpu/segmentation/label_rig.h"

namespace patina::label_pixels_test {
namespace {

class LabelPixels : public GpuTest {};

/// Segments are known of every so many-th pixel in x and y.
class LabelPixelsAtStride : public GpuTest, public ::testing::WithParamInterface<uint32_t> {};

/// The map is asked at every kStride-th pixel in x and y; what it says there holds for those of the same segment, or of
/// none.
constexpr uint32_t kStride = gpu::kSampleStride;

TEST_P(LabelPixelsAtStride, AreTheMapsElseTheirSegments) {
    const uint32_t stride = GetParam();
    constexpr uint32_t kLabels = 500, kSegments = 90;
    for (const Extent2D extent : kPictureExtents) {
        std::mt19937 random(extent.width);
        const auto below = [&](uint32_t end) { return static_cast<uint32_t>(random() % end); };
        Image<uint32_t> map_label({(extent.width + kStride - 1) / kStride, (extent.height + kStride - 1) / kStride});
        Image<uint32_t> segment(sampled_extent(extent, stride));
        for (uint32_t& label : map_label.pixels()) label = below(2) == 0 ? 0 : below(kLabels);
        for (uint32_t i = 0; i < segment.extent().area(); ++i)
            segment.pixels()[i] = i > 0 && below(3) != 0 ? segment.pixels()[i - 1] : below(kSegments);
        const std::vector<uint32_t> roots = random_roots(kLabels, random);
        std::vector<uint32_t> segment_labels(kSegments);
        for (uint32_t s = 1; s < kSegments; ++s) segment_labels[s] = below(4) == 0 ? 0 : below(kLabels);

        graph::FrameGraph frame = runner().begin();
        const auto upload = [&](const char* name, const Image<uint32_t>& image) {
            return frame.upload(name, {image.extent(), vulkan::Format::kR32u},
                                std::as_bytes(std::span(image.pixels())));
        };
        const FrameSegments segments{upload("segment", segment), {}, {}, stride};
        const graph::Readback read = frame.read_back(
            add_label_pixels(frame, segments, upload("map_label", map_label), frame.upload<uint32_t>("parents", roots),
                             frame.upload<uint32_t>("segment_labels", segment_labels), extent));
        run(std::move(frame));
        const Image<uint32_t> got = read.image<uint32_t>();
        for (uint32_t y = 0; y < extent.height; ++y) {
            for (uint32_t x = 0; x < extent.width; ++x) {
                const auto segment_at = [&](uint32_t u, uint32_t v) { return segment.at(u / stride, v / stride); };
                const uint32_t own = segment_at(x, y);
                const bool same = own == 0 || segment_at(x / kStride * kStride, y / kStride * kStride) == own;
                const uint32_t known = same ? map_label.at(x / kStride, y / kStride) : 0;
                ASSERT_EQ(got.at(x, y), reference::pixel_label(known, own, roots, segment_labels))
                    << extent << ", pixel " << x << ' ' << y;
            }
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Strides, LabelPixelsAtStride, ::testing::Values(1u, 2u));

TEST_F(LabelPixels, LabelsOfAnotherExtentAreRefused) {
    graph::FrameGraph frame = runner().begin();
    const Image<uint32_t> image({8, 6});
    const auto upload = [&](const char* name) {
        return frame.upload(name, {image.extent(), vulkan::Format::kR32u}, std::as_bytes(std::span(image.pixels())));
    };
    const std::vector<uint32_t> one(1);
    const FrameSegments segments{upload("segment"), {}, {}};
    EXPECT_THAT(
        [&] {
            add_label_pixels(frame, segments, upload("map_label"), frame.upload<uint32_t>("parents", one),
                             frame.upload<uint32_t>("segment_labels", one), image.extent());
        },
        testing::ThrowsMessage<Error>(testing::HasSubstr("it must be 4 x 3")));
}

}  // namespace
}  // namespace patina::label_pixels_test
