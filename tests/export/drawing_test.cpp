#include "tools/report/drawing.h"

#include <limits>

#include <gmock/gmock.h>
#include <opencv2/imgcodecs.hpp>

namespace patina::drawing_test {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

TEST(Drawing, ColoursAreEncodedAndClipped) {
    EXPECT_EQ(color_pixel({0.215861f, 1, 0}), SrgbPixel(128, 255, 0));
    EXPECT_EQ(color_pixel({2, -1, kNan}), SrgbPixel(255, 0, 0));
    EXPECT_EQ(normal_pixel({0, 1, -1}), SrgbPixel(128, 255, 0));
}

TEST(Drawing, ColourMapsAreClipped) {
    for (const ColorMap map : {ColorMap::kTurbo, ColorMap::kViridis, ColorMap::kInferno}) {
        EXPECT_EQ(map_pixel(map, -1), map_pixel(map, 0));
        EXPECT_EQ(map_pixel(map, kNan), map_pixel(map, 0));
        EXPECT_EQ(map_pixel(map, 2), map_pixel(map, 1));
    }
    const SrgbPixel near_blue = map_pixel(ColorMap::kTurbo, 0.1f), near_red = map_pixel(ColorMap::kTurbo, 0.9f);
    EXPECT_GT(near_blue.b, near_blue.r);
    EXPECT_GT(near_red.r, near_red.b);
}

// What makes a map readable in grey print.
TEST(Drawing, EvenMapsBecomeLighterAllTheWay) {
    for (const ColorMap map : {ColorMap::kViridis, ColorMap::kInferno}) {
        float last = -1;
        for (int i = 0; i <= 16; ++i) {
            const SrgbPixel color = map_pixel(map, static_cast<float>(i) / 16);
            const float luma = 0.2126f * color.r + 0.7152f * color.g + 0.0722f * color.b;
            EXPECT_GT(luma, last) << i;
            last = luma;
        }
    }
}

TEST(Drawing, ExtentsKeepTheirProportions) {
    EXPECT_EQ(fitted_extent({512, 424}, 256), (Extent2D{256, 212}));
    EXPECT_EQ(fitted_extent({200, 100}, 256), (Extent2D{200, 100}));
    EXPECT_EQ(fitted_extent({1000, 1}, 10), (Extent2D{10, 1}));
}

TEST(Drawing, ShrinkingAverages) {
    Drawing drawing({2, 1});
    drawing.at(0, 0) = {100, 0, 10};
    drawing.at(1, 0) = {200, 50, 20};
    EXPECT_EQ(scaled_to(drawing, {1, 1}).at(0, 0), SrgbPixel(150, 25, 15));
    EXPECT_EQ(scaled_to(drawing, {2, 1}).pixels(), drawing.pixels());
}

TEST(Drawing, PngHoldsThePixels) {
    Drawing drawing({3, 2}, {10, 20, 30});
    drawing.at(2, 1) = {1, 2, 3};
    const std::string png = png_of(drawing);
    const cv::Mat decoded = cv::imdecode(std::vector<uchar>(png.begin(), png.end()), cv::IMREAD_COLOR);
    ASSERT_EQ(decoded.size(), cv::Size(3, 2));
    EXPECT_EQ(decoded.at<cv::Vec3b>(1, 2), cv::Vec3b(3, 2, 1));
    EXPECT_EQ(decoded.at<cv::Vec3b>(0, 0), cv::Vec3b(30, 20, 10));
}

}  // namespace
}  // namespace patina::drawing_test
