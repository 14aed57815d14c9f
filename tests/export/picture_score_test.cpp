#include "tools/report/picture_score.h"

#include <cmath>

#include <gmock/gmock.h>

#include "engine/core/srgb.h"
#include "tools/report/drawing.h"

namespace patina::picture_score_test {
namespace {

TEST(PictureScore, IsThePsnrOverWhatIsPredicted) {
    const Image<glm::vec3> seen({2, 2}, glm::vec3(0.5f));
    Image<glm::vec4> predicted({2, 2}, glm::vec4(0.4f, 0.6f, 0.5f, 1));
    predicted.at(0, 0) = {9, 9, 9, 0};
    const PictureScore score = score_picture(seen, predicted);
    EXPECT_EQ(score.coverage, 0.75);
    EXPECT_NEAR(score.psnr_linear_db, -10 * std::log10(0.02 / 3), 1e-4);
    const glm::dvec3 off = (glm::dvec3(color_pixel({0.4, 0.6, 0.5})) - glm::dvec3(color_pixel(glm::vec3(0.5)))) / 255.0;
    EXPECT_NEAR(score.psnr_srgb_db, -10 * std::log10(glm::dot(off, off) / 3), 1e-4);
}

TEST(PictureScore, BothAreClippedAsACameraDoes) {
    const PictureScore score =
        score_picture(Image<glm::vec3>({1, 1}, glm::vec3(1)), Image<glm::vec4>({1, 1}, glm::vec4(3, 2, 1, 1)));
    EXPECT_EQ(score.psnr_linear_db, 100);
    EXPECT_EQ(score.psnr_srgb_db, 100);
}

TEST(PictureScore, NothingPredictedScoresNothing) {
    const PictureScore score = score_picture(Image<glm::vec3>({2, 1}), Image<glm::vec4>({2, 1}));
    EXPECT_EQ(score.coverage, 0);
    EXPECT_EQ(score.psnr_linear_db, 0);
}

TEST(PictureScore, PicturesOfTwoSizesAreRefused) {
    EXPECT_THROW(score_picture(Image<glm::vec3>({2, 1}), Image<glm::vec4>({1, 2})), Error);
}

TEST(PictureScore, TheGainBetweenIsTheMedianRatioOfWhatIsNeitherDarkNorBright) {
    const Extent2D extent{20, 20};
    Image<glm::vec3> seen(extent, glm::vec3(0.4f, 0.3f, 0.2f));
    Image<glm::vec4> predicted(extent, glm::vec4(0.5f, 0.3f, 0.1f, 1));
    for (size_t i = 0; i < 150; ++i) seen.pixels()[i] = glm::vec3(1);            // clipped
    for (size_t i = 150; i < 190; ++i) predicted.pixels()[i] = glm::vec4(0.6f);  // few
    for (size_t i = 190; i < 200; ++i) predicted.pixels()[i].a = 0;
    const glm::vec3 gain = gain_between(seen, predicted);
    EXPECT_NEAR(gain.r, 0.8f, 1e-6);
    EXPECT_NEAR(gain.g, 1, 1e-6);
    EXPECT_NEAR(gain.b, 2, 1e-6);
    EXPECT_EQ(gain_between(Image<glm::vec3>(extent), predicted), glm::vec3(1)) << "nothing to compare";
}

TEST(PictureScore, MediansAreOfEachNumberAlone) {
    const std::vector<PictureScore> scores{{0.1, 30, 5}, {0.3, 10, 7}, {0.2, 20, 9}, {0.4, 25, 8}};
    const PictureScore median = median_of(scores);
    EXPECT_DOUBLE_EQ(median.coverage, 0.25);
    EXPECT_DOUBLE_EQ(median.psnr_linear_db, 22.5);
    EXPECT_DOUBLE_EQ(median.psnr_srgb_db, 7.5);
    EXPECT_EQ(median_of(std::vector<PictureScore>{}).coverage, 0);
}

TEST(PictureScore, LinearColourIsTheInverseOfTheEncoding) {
    for (int code = 0; code < 256; ++code) {
        const SrgbPixel pixel(code, 255 - code, 7);
        EXPECT_EQ(color_pixel(linear_color(pixel)), pixel);
    }
}

}  // namespace
}  // namespace patina::picture_score_test
