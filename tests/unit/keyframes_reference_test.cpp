#include <cmath>

#include <gtest/gtest.h>

#include "tests/reference/tracking/keyframes.h"

namespace patina::reference::keyframes_reference_test {
namespace {

TEST(KeyframesReference, AStepOfDepthIsBlurredAsTheErrorFunctionSays) {
    Image<float> depth_m({400, 300});
    for (uint32_t y = 0; y < 300; ++y) {
        for (uint32_t x = 0; x < 400; ++x) depth_m.at(x, y) = x < 200 ? 1.0f : 3.0f;
    }
    const Image<SmallPixel> small = small_picture(depth_m, Image<glm::vec4>({400, 300}));
    EXPECT_NEAR(small.at(5, 15).depth_m.value(), 1, 1e-12);
    EXPECT_NEAR(small.at(35, 15).depth_m.value(), 3, 1e-12);
    // Two pixels right of the step, whose edge lies half a pixel before the centre of pixel 20.
    const double expected = 2 + std::erf(2.5 / (2.5 * std::sqrt(2.0)));
    EXPECT_NEAR(small.at(22, 15).depth_m.value(), expected, 0.01);  // a sum over pixels, cut off at 2.8 sigma
    EXPECT_FALSE(small.at(22, 15).color);
}

TEST(KeyframesReference, DissimilarityIsAShareOfWhatBothKnow) {
    const FernCode red{std::array{true, false, false}, true}, dark{std::array{false, false, false}, true};
    const FernCode unknown{}, far{std::array{true, false, false}, false};
    const std::vector<FernCode> a{red, red, red, red, red, unknown}, b{red, dark, far, unknown, red, red};
    EXPECT_EQ(dissimilarity(a, b, false), 0.5);  // 2 of 4
    EXPECT_EQ(dissimilarity(a, b, true), 0.25);  // colour does not count
    EXPECT_EQ(dissimilarity(std::vector(8, unknown), std::vector(8, red), false), 1);
    const FernCode colorless{{}, true};
    EXPECT_EQ(dissimilarity(std::vector(8, colorless), std::vector(8, red), false), 0);
}

}  // namespace
}  // namespace patina::reference::keyframes_reference_test
