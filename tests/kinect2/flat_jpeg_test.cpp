#include "tests/simulated_kinect2/flat_jpeg.h"

#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

namespace patina::sensor::kinect2::testing::flat_jpeg_test {
namespace {

TEST(FlatJpeg, EveryPixelHasTheGrey) {
    for (const int grey : {0, 1, 64, 127, 128, 129, 200, 255}) {
        const cv::Mat picture = cv::imdecode(flat_jpeg(1920, 1080, static_cast<uint8_t>(grey)), cv::IMREAD_COLOR);
        ASSERT_EQ(picture.size(), cv::Size(1920, 1080));
        double low = 0, high = 0;
        cv::minMaxLoc(picture.reshape(1), &low, &high);
        EXPECT_NEAR(low, grey, 1);
        EXPECT_NEAR(high, grey, 1);
    }
}

}  // namespace
}  // namespace patina::sensor::kinect2::testing::flat_jpeg_test
