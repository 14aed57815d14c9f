#include "tools/eval/error_figures.h"

#include <gmock/gmock.h>
#include <opencv2/imgcodecs.hpp>

#include "tests/eval/eval_rig.h"
#include "tests/export/throws.h"

namespace patina::eval::error_figures_test {
namespace {

using test::EvalFrame;
using test::EvalRig;
using testing::ElementsAre;

constexpr glm::u8vec3 kNoTruth(56, 56, 56), kHatch(150, 150, 150);
constexpr glm::uvec2 kOnFloor(10, 20), kOnBackground(20, 3);

cv::Mat decode(const std::string& png) {
    const std::vector<uchar> bytes(png.begin(), png.end());
    return cv::imdecode(bytes, cv::IMREAD_COLOR);
}

glm::u8vec3 pixel(const std::string& png, glm::uvec2 at) {
    const cv::Vec3b bgr = decode(png).at<cv::Vec3b>(static_cast<int>(at.y), static_cast<int>(at.x));
    return {bgr[2], bgr[1], bgr[0]};
}

/// The first frame's row of this title.
ErrorRow row_of(const std::vector<ErrorFigure>& figures, const std::string& title) {
    for (const ErrorRow& row : figures.at(0).rows) {
        if (row.title == title) return row;
    }
    ADD_FAILURE() << "no row " << title;
    return {};
}

std::vector<std::string> titles_of(const ErrorFigure& figure) {
    std::vector<std::string> titles;
    for (const ErrorRow& row : figure.rows) titles.push_back(row.title);
    return titles;
}

TEST(ErrorFigures, ShowFirstMiddleAndLastFrame) {
    const EvalRig rig;
    const auto figures = error_figures(rig.evaluate());
    ASSERT_EQ(figures.size(), 3u);
    EXPECT_EQ(figures[0].frame, 0u);
    EXPECT_EQ(figures[1].frame, 20u);
    EXPECT_EQ(figures[2].frame, 30u);
    EXPECT_THAT(titles_of(figures[0]),
                ElementsAre("kd", "kd refined", "ks", "alpha", "RGB", "RGB refined", "kd shown", "RGB shown", "depth"));
    EXPECT_EQ(decode(figures[0].rows[0].truth).size(), cv::Size(48, 40));
}

TEST(ErrorFigures, PerfectRunsAreBlack) {
    const EvalRig rig;
    const auto figures = error_figures(rig.evaluate());
    const glm::u8vec3 lowest = pixel(figures[0].rows[0].errors.png, {0, 0});
    for (const ErrorRow& row : figures[0].rows) {
        EXPECT_EQ(pixel(row.error, kOnFloor), lowest) << row.title;
        EXPECT_EQ(pixel(row.run, kOnFloor), pixel(row.truth, kOnFloor)) << row.title;
        EXPECT_EQ(pixel(row.error, kOnBackground), kNoTruth) << row.title;
    }
}

TEST(ErrorFigures, KnownErrorsHaveTheirColour) {
    const EvalRig rig;
    rig.change_frames([](EvalFrame& frame) {
        for (glm::vec3& kd : frame.kd_segment.pixels()) kd += glm::vec3(0.192f, -0.096f, 0);  // 0.096 on average
        for (glm::vec3& kd : frame.kd.pixels()) kd += 0.046f;
        for (float& depth : frame.depth.pixels()) depth += 0.0095f;
    });
    const auto figures = error_figures(rig.evaluate());
    const ErrorRow before = row_of(figures, "kd"), after = row_of(figures, "kd refined"),
                   depth = row_of(figures, "depth");
    EXPECT_EQ(before.errors.high, "0.1");
    EXPECT_EQ(after.errors.high, "0.1") << "before and after share a scale";
    EXPECT_EQ(pixel(before.error, kOnFloor), pixel(before.errors.png, {245, 0}));
    EXPECT_EQ(pixel(after.error, kOnFloor), pixel(before.errors.png, {117, 0}));
    EXPECT_EQ(depth.errors.high, "10 mm");
    EXPECT_EQ(depth.values->high, "3 m");
    // Linear 0.6 + 0.046 is 210 in sRGB, 0.4 + 0.046 is 178.
    EXPECT_EQ(pixel(after.run, kOnFloor).r, 210);
    EXPECT_EQ(pixel(after.run, kOnFloor).b, 178);
}

TEST(ErrorFigures, UnfilledPixelsAreHatched) {
    const EvalRig rig;
    rig.change_frames([](EvalFrame& frame) { frame.valid = Image<float>(frame.valid.extent()); });
    const ErrorRow row = row_of(error_figures(rig.evaluate()), "ks");
    for (const std::string& png : {row.run, row.error}) {
        std::set<int> greys;
        for (unsigned x = 8; x < 16; ++x) {
            const glm::u8vec3 color = pixel(png, {x, 20});
            EXPECT_EQ(color.r, color.g);
            greys.insert(color.r);
        }
        EXPECT_THAT(greys, ElementsAre(kNoTruth.r, kHatch.r));
        EXPECT_EQ(pixel(png, kOnBackground), kNoTruth);
    }
    EXPECT_NE(pixel(row.truth, kOnFloor), kNoTruth);
}

TEST(ErrorFigures, ShowOnlyWhatTheRunHas) {
    const EvalRig rig;
    rig.change_frames([](EvalFrame&) {},
                      {"kd", "kd_segment", "kd_shown", "ks", "alpha", "rgb_segment", "rgb_shown", "label"});
    EXPECT_THAT(titles_of(error_figures(rig.evaluate()).at(0)), ElementsAre("RGB refined", "depth"));
}

TEST(ErrorFigures, OneFrameIsShownOnce) {
    const EvalRig rig;
    for (const uint32_t index : {0, 10, 30}) std::filesystem::remove(rig.run_frame(index));
    const auto figures = error_figures(rig.evaluate());
    ASSERT_EQ(figures.size(), 1u);
    EXPECT_EQ(figures[0].frame, 20u);
    EXPECT_TRUE(error_figures({}).empty());
}

}  // namespace
}  // namespace patina::eval::error_figures_test
