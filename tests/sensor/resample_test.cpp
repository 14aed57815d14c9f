#include "sensor/resample.h"

#include <gmock/gmock.h>

#include "tests/sensor/sequences.h"

namespace patina::sensor::resample_test {
namespace {

using namespace testing;

Frame resampled(const Frame& frame, Extent2D color, Extent2D depth) {
    ResampledSource source(std::make_unique<MemorySource>(test_info(), std::vector<Reading>{frame}), color, depth);
    return std::get<Frame>(source.next().value());
}

TEST(Resample, ScalesIntrinsicsAndPictures) {
    ResampledSource source(std::make_unique<MemorySource>(test_info(), test_readings(2)), {16, 12}, {8, 6});
    EXPECT_EQ(source.info().color, scaled_to(test_info().color, {16, 12}));
    EXPECT_EQ(source.info().depth, scaled_to(test_info().depth, {8, 6}));
    const std::vector<Reading> readings = read_all(source);
    ASSERT_EQ(readings.size(), 2u);
    const Frame& frame = std::get<Frame>(readings[1]);
    EXPECT_EQ(std::get<Image<SrgbPixel>>(frame.color).extent(), (Extent2D{16, 12}));
    EXPECT_EQ(std::get<Image<uint16_t>>(frame.depth).extent(), (Extent2D{8, 6}));
    EXPECT_EQ(frame.index, 1u);
}

TEST(Resample, ShrunkColourIsTheMeanOfItsArea) {
    Frame frame = test_frame(0, {4, 2}, {1, 1});
    auto& color = std::get<Image<SrgbPixel>>(frame.color);
    for (uint32_t i = 0; i < 8; ++i) color.pixels()[i] = SrgbPixel(static_cast<uint8_t>(10 * i), 7, 200);
    const auto small = std::get<Image<SrgbPixel>>(resampled(frame, {2, 1}, {1, 1}).color);
    EXPECT_EQ(small.at(0, 0), SrgbPixel(25, 7, 200));  // of 0, 10, 40, 50
    EXPECT_EQ(small.at(1, 0), SrgbPixel(45, 7, 200));  // of 20, 30, 60, 70
}

TEST(Resample, DepthIsNeverMixed) {
    Frame frame = test_frame(0, {1, 1}, {6, 1});
    frame.depth = Image<uint16_t>({6, 1}, std::vector<uint16_t>{0, 1, 2, 3, 4, 5});
    frame.color = Image<glm::vec3>({1, 1}, glm::vec3(0.5f));
    // A third pixel of 6 / 4 is centred at 3.75: in source pixel 3.
    EXPECT_EQ(std::get<Image<uint16_t>>(resampled(frame, {2, 2}, {4, 1}).depth).pixels(),
              (std::vector<uint16_t>{0, 2, 3, 5}));
    EXPECT_EQ(std::get<Image<uint16_t>>(resampled(frame, {2, 2}, {3, 1}).depth).pixels(),
              (std::vector<uint16_t>{1, 3, 5}));
    EXPECT_EQ(std::get<Image<uint16_t>>(resampled(frame, {2, 2}, {6, 1}).depth).pixels(),
              (std::vector<uint16_t>{0, 1, 2, 3, 4, 5}));
    EXPECT_EQ(std::get<Image<glm::vec3>>(resampled(frame, {2, 2}, {6, 1}).color).at(1, 1), glm::vec3(0.5f));
}

TEST(Resample, SkippedFramesPassAndEmptySizesAreErrors) {
    ResampledSource source(std::make_unique<MemorySource>(test_info(), std::vector<Reading>{Skipped{0, "why"}}), {1, 1},
                           {1, 1});
    EXPECT_EQ(std::get<Skipped>(source.next().value()).reason, "why");
    EXPECT_EQ(error_of([] {
                  ResampledSource(std::make_unique<MemorySource>(test_info(), test_readings(1)), {0, 5}, {1, 1});
              }),
              "test cannot be resampled to 0 x 5 and 1 x 1 pixels");
}

}  // namespace
}  // namespace patina::sensor::resample_test
