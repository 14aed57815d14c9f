#include "sensor/repeated.h"

#include <gmock/gmock.h>

namespace patina::sensor::repeated_test {
namespace {

using ::testing::Optional;

Frame frame_of(uint32_t index, uint8_t red, uint16_t depth) {
    Frame frame;
    frame.index = index;
    frame.timestamp_s = 0.1 * index;
    frame.color = Image<SrgbPixel>({4, 3}, SrgbPixel(red, 20, 30));
    frame.depth = Image<uint16_t>({4, 3}, depth);
    return frame;
}

TEST(Repeated, OneWithTheSamePictureAndDepth) {
    EXPECT_THAT(repeats(frame_of(8, 1, 900), frame_of(7, 1, 900)),
                Optional(std::string("its picture and depth are those of frame 7")));
}

/// Cameras of another rate than the depth's send one of the two again.
TEST(Repeated, NotOneWhosePictureOrDepthIsNew) {
    EXPECT_EQ(repeats(frame_of(8, 2, 900), frame_of(7, 1, 900)), std::nullopt);
    EXPECT_EQ(repeats(frame_of(8, 1, 901), frame_of(7, 1, 900)), std::nullopt);
    Frame one_pixel = frame_of(8, 1, 900);
    std::get<Image<uint16_t>>(one_pixel.depth).at(3, 2) = 901;
    EXPECT_EQ(repeats(one_pixel, frame_of(7, 1, 900)), std::nullopt);
}

TEST(Repeated, OneWithTheSameTime) {
    Frame later = frame_of(8, 2, 901);
    later.timestamp_s = frame_of(7, 1, 900).timestamp_s;
    EXPECT_THAT(repeats(later, frame_of(7, 1, 900)), Optional(std::string("it has the time of frame 7")));
}

TEST(Repeated, PicturesOfAnotherKindOrExtentDiffer) {
    EXPECT_FALSE(same_pixels(DepthImage(Image<uint16_t>({2, 2})), DepthImage(Image<float>({2, 2}))));
    EXPECT_FALSE(same_pixels(DepthImage(Image<uint16_t>({4, 1})), DepthImage(Image<uint16_t>({2, 2}))));
    EXPECT_TRUE(same_pixels(DepthImage(Image<uint16_t>({2, 2})), DepthImage(Image<uint16_t>({2, 2}))));
}

}  // namespace
}  // namespace patina::sensor::repeated_test
