#include "tools/report/previews.h"

#include <limits>

#include <gmock/gmock.h>
#include <opencv2/imgcodecs.hpp>

#include "tests/export/throws.h"

namespace patina::previews_test {
namespace {

using test::throws_error_with;

constexpr int kCaptionHeight = 24, kGap = 4;
constexpr Extent2D kExtent{120, 80};
constexpr glm::u8vec3 kGrey(56, 56, 56);

/// Left half hit, right half not.
FrameDump half_seen(Extent2D extent) {
    FrameDump frame{Image<glm::vec3>(extent), Image<float>(extent), Image<glm::vec3>(extent), Image<float>(extent)};
    for (uint32_t y = 0; y < extent.height; ++y) {
        for (uint32_t x = 0; x < extent.width / 2; ++x) {
            frame.rgb.at(x, y) = {0.215861f, 1, 0};  // sRGB 128, 255, 0
            frame.normal.at(x, y) = {0, 0, -1};
            frame.depth_m.at(x, y) = y < extent.height / 2 ? 1.0f : 3.0f;
            frame.valid.at(x, y) = 1;
        }
    }
    return frame;
}

Image<SrgbPixel> input_of(Extent2D extent) { return Image<SrgbPixel>(extent, {200, 100, 50}); }

cv::Mat decode(const std::string& png) {
    const std::vector<uchar> bytes(png.begin(), png.end());
    return cv::imdecode(bytes, cv::IMREAD_COLOR);
}

/// The RGB pixel (x, y) of panel `panel`, where panels are `width` wide.
glm::u8vec3 pixel(const cv::Mat& sheet, int width, int panel, int x, int y) {
    const cv::Vec3b bgr = sheet.at<cv::Vec3b>(kCaptionHeight + y, panel * (width + kGap) + x);
    return {bgr[2], bgr[1], bgr[0]};
}

TEST(Previews, ShowsInputColourAndNormalsSideBySide) {
    const cv::Mat sheet = decode(preview_png(input_of(kExtent), half_seen(kExtent), {.title = "frame 3"}));
    ASSERT_EQ(sheet.size(), cv::Size(3 * 120 + 2 * kGap, 80 + kCaptionHeight));
    EXPECT_EQ(pixel(sheet, 120, 0, 10, 10), glm::u8vec3(200, 100, 50));
    EXPECT_EQ(pixel(sheet, 120, 0, 119, 79), glm::u8vec3(200, 100, 50));
    EXPECT_EQ(pixel(sheet, 120, 1, 59, 79), glm::u8vec3(128, 255, 0));
    EXPECT_EQ(pixel(sheet, 120, 1, 60, 0), kGrey);
    EXPECT_EQ(pixel(sheet, 120, 2, 0, 0), glm::u8vec3(128, 128, 0));
    EXPECT_EQ(pixel(sheet, 120, 2, 119, 79), kGrey);
}

TEST(Previews, APairIsTheRecordedPictureAndTheRerendering) {
    const auto color_at = [](const std::string& jpeg, int x, int y) {
        const cv::Vec3b bgr = decode(jpeg).at<cv::Vec3b>(y, x);
        return glm::ivec3(bgr[2], bgr[1], bgr[0]);
    };
    const PicturePair pair = picture_pair(ColorImage(input_of({1920, 1080})), half_seen({1920, 1080}), "frame 3");
    EXPECT_EQ(pair.caption, "frame 3");
    EXPECT_EQ(pair.extent, (Extent2D{960, 540}));
    EXPECT_EQ(decode(pair.recorded).size(), cv::Size(960, 540));
    EXPECT_EQ(decode(pair.rendered).size(), cv::Size(960, 540));
    EXPECT_LT(glm::length(glm::vec3(color_at(pair.recorded, 100, 100) - glm::ivec3(200, 100, 50))), 12.0f);
    EXPECT_LT(glm::length(glm::vec3(color_at(pair.rendered, 100, 100) - glm::ivec3(128, 255, 0))), 12.0f);
}

TEST(Previews, DepthRunsFromBlueToRed) {
    const cv::Mat sheet = decode(preview_png(input_of(kExtent), half_seen(kExtent), {.depth = true}));
    ASSERT_EQ(sheet.cols, 4 * 120 + 3 * kGap);
    const glm::u8vec3 near_color = pixel(sheet, 120, 3, 10, 10), far_color = pixel(sheet, 120, 3, 10, 70);
    EXPECT_GT(near_color.b, near_color.r);
    EXPECT_GT(far_color.r, far_color.b);
    EXPECT_EQ(pixel(sheet, 120, 3, 100, 40), kGrey);
}

TEST(Previews, ReflectanceHasPanelsOfItsOwn) {
    FrameDump frame = half_seen(kExtent);
    frame.kd = Image<glm::vec3>(kExtent, {0, 0.215861f, 1});
    frame.label = Image<float>(kExtent, 0.0f);
    EXPECT_EQ(decode(preview_png(input_of(kExtent), frame)).cols, 4 * 120 + 3 * kGap) << "no segments, no panel";
    for (uint32_t y = 0; y < 40; ++y) {
        for (uint32_t x = 0; x < 120; ++x) frame.label.at(x, y) = x < 30 ? 1.0f : 2.0f;
    }
    const cv::Mat sheet = decode(preview_png(input_of(kExtent), frame));
    ASSERT_EQ(sheet.cols, 5 * 120 + 4 * kGap);
    EXPECT_EQ(pixel(sheet, 120, 1, 59, 79), glm::u8vec3(128, 255, 0)) << "re-rendering";
    EXPECT_EQ(pixel(sheet, 120, 2, 10, 10), glm::u8vec3(0, 128, 255)) << "albedo";
    EXPECT_EQ(pixel(sheet, 120, 3, 10, 60), kGrey) << "no label";
    EXPECT_NE(pixel(sheet, 120, 3, 10, 10), pixel(sheet, 120, 3, 40, 10));
    EXPECT_EQ(pixel(sheet, 120, 4, 0, 0), glm::u8vec3(128, 128, 0)) << "normals";
}

TEST(Previews, EveryPanelHasACaption) {
    const cv::Mat sheet = decode(preview_png(input_of(kExtent), half_seen(kExtent), {.depth = true}));
    for (int panel = 0; panel < 4; ++panel) {
        double brightest = 0;
        cv::Mat strip = sheet(cv::Rect(panel * (120 + kGap), 0, 120, kCaptionHeight)).clone();
        cv::minMaxLoc(strip.reshape(1), nullptr, &brightest);
        EXPECT_GT(brightest, 150) << panel;
    }
}

TEST(Previews, InputMayBeLinearAndOfAnotherSize) {
    const Image<glm::vec3> linear({60, 40}, {0.215861f, 2, -1});
    const cv::Mat sheet = decode(preview_png(linear, half_seen(kExtent)));
    EXPECT_EQ(pixel(sheet, 120, 0, 119, 79), glm::u8vec3(128, 255, 0));
}

TEST(Previews, WidePicturesAreScaledDown) {
    const cv::Mat sheet = decode(preview_png(input_of({400, 300}), half_seen({400, 300}), {.largest_panel_px = 100}));
    ASSERT_EQ(sheet.size(), cv::Size(3 * 100 + 2 * kGap, 75 + kCaptionHeight));
    EXPECT_EQ(pixel(sheet, 100, 2, 20, 20), glm::u8vec3(128, 128, 0));
}

TEST(Previews, SurvivesNothingSeenAndValuesThatAreNotFinite) {
    FrameDump frame = half_seen(kExtent);
    const float nan = std::numeric_limits<float>::quiet_NaN();
    frame.rgb.at(5, 5) = glm::vec3(nan);
    frame.depth_m.at(5, 5) = nan;
    EXPECT_EQ(pixel(decode(preview_png(input_of(kExtent), frame, {.depth = true})), 120, 1, 5, 5), glm::u8vec3(0));
    frame.valid = Image<float>(kExtent);
    EXPECT_EQ(pixel(decode(preview_png(input_of(kExtent), frame, {.depth = true})), 120, 3, 5, 5), kGrey);
    EXPECT_FALSE(preview_png(input_of({1, 1}), half_seen({1, 1}), {.depth = true}).empty());
}

TEST(Previews, TheSamePicturesGiveTheSameBytes) {
    EXPECT_EQ(preview_png(input_of(kExtent), half_seen(kExtent)), preview_png(input_of(kExtent), half_seen(kExtent)));
}

TEST(Previews, SaysWhichPictureDoesNotFit) {
    FrameDump frame = half_seen(kExtent);
    EXPECT_THAT([&] { preview_png(input_of({}), frame); }, throws_error_with("the input picture is empty"));
    EXPECT_THAT([&] { preview_png(input_of(kExtent), {}); }, throws_error_with("the reconstruction picture is empty"));
    frame.normal = Image<glm::vec3>({7, 5});
    EXPECT_THAT([&] { preview_png(input_of(kExtent), frame); },
                throws_error_with("the normal picture is 7 x 5 but the colour is 120 x 80"));
}

}  // namespace
}  // namespace patina::previews_test
