#include "passes/segmentation/label_pixels.h"

#include "tests/gpu/gpu_test.h"
#include "tests/gpu/input_pictures.h"
#include "tests/gpu/label_rig.h"

namespace patina {
namespace {

class LabelPixels : public GpuTest {};

TEST_F(LabelPixels, AreTheMapsElseTheirSegments) {
    constexpr uint32_t kLabels = 500, kSegments = 90;
    for (const Extent2D extent : kPictureExtents) {
        std::mt19937 random(extent.width);
        const auto below = [&](uint32_t end) { return static_cast<uint32_t>(random() % end); };
        Image<uint32_t> map_label(extent), segment(extent);
        for (uint32_t& label : map_label.pixels()) label = below(2) == 0 ? 0 : below(kLabels);
        for (uint32_t& number : segment.pixels()) number = below(kSegments);
        const std::vector<uint32_t> roots = random_roots(kLabels, random);
        std::vector<uint32_t> segment_labels(kSegments);
        for (uint32_t s = 1; s < kSegments; ++s) segment_labels[s] = below(4) == 0 ? 0 : below(kLabels);

        graph::Frame frame = runner().begin();
        const auto upload = [&](const char* name, const Image<uint32_t>& image) {
            return frame.upload(name, {extent, vulkan::Format::kR32u}, std::as_bytes(std::span(image.pixels())));
        };
        const FrameSegments segments{upload("segment", segment), {}, {}};
        const graph::Readback read = frame.read_back(
            add_label_pixels(frame, segments, upload("map_label", map_label), frame.upload<uint32_t>("parents", roots),
                             frame.upload<uint32_t>("segment_labels", segment_labels)));
        run(std::move(frame));
        const Image<uint32_t> got = read.image<uint32_t>();
        for (size_t i = 0; i < extent.area(); ++i) {
            ASSERT_EQ(got.pixels()[i],
                      reference::pixel_label(map_label.pixels()[i], segment.pixels()[i], roots, segment_labels))
                << extent << ", pixel " << i;
        }
    }
}

}  // namespace
}  // namespace patina
