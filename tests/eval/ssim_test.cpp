#include "tools/eval/ssim.h"

#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "tests/eval/pictures.h"
#include "tests/reference/eval/ssim.h"

namespace patina::eval::ssim_test {
namespace {

using test::picture_of;
using test::random_mask;
using test::random_picture;

// Both are double precision; the library takes the variance as a difference of sums of size 1.
constexpr double kTolerance = 1e-9;

Image<uint8_t> full(Extent2D extent) { return Image<uint8_t>(extent, 1); }

double ssim_of(const Image<float>& x, const Image<float>& y, const Image<uint8_t>& mask) {
    return ssim({&x, 1}, {&y, 1}, mask, mask).filled.value();
}

Image<uint8_t> both(const Image<uint8_t>& a, const Image<uint8_t>& b) {
    return picture_of<uint8_t>(a.extent(), [&](uint32_t x, uint32_t y) { return a.at(x, y) & b.at(x, y); });
}

TEST(Ssim, OfAPictureWithItselfIsOne) {
    for (const Extent2D extent : {Extent2D{1, 1}, {3, 40}, {40, 3}, {37, 29}}) {
        const Image<float> picture = random_picture(extent, 1);
        EXPECT_DOUBLE_EQ(ssim_of(picture, picture, full(extent)), 1) << extent;
        EXPECT_DOUBLE_EQ(ssim_of(picture, picture, random_mask(extent, 2, 0.3)), 1) << extent;
    }
}

TEST(Ssim, IsSymmetric) {
    const Image<float> x = random_picture({31, 23}, 1), y = random_picture({31, 23}, 2);
    const Image<uint8_t> mask = random_mask({31, 23}, 3, 0.7);
    EXPECT_DOUBLE_EQ(ssim_of(x, y, mask), ssim_of(y, x, mask));
}

TEST(Ssim, OfConstantsIsTheLuminanceTermAlone) {
    const Extent2D extent{20, 20};
    const double expected = (2 * 0.25 * 0.75 + 1e-4) / (0.25 * 0.25 + 0.75 * 0.75 + 1e-4);
    EXPECT_NEAR(ssim_of(Image<float>(extent, 0.25f), Image<float>(extent, 0.75f), full(extent)), expected, kTolerance);
}

TEST(Ssim, OfAMirroredContrastIsNegative) {
    const auto checker = [](uint32_t x, uint32_t y) { return (x + y) % 2 == 0 ? 0.4f : 0.6f; };
    const auto inverse = [&](uint32_t x, uint32_t y) { return 1 - checker(x, y); };
    const Extent2D extent{24, 24};
    EXPECT_LT(ssim_of(picture_of<float>(extent, checker), picture_of<float>(extent, inverse), full(extent)), -0.8);
}

TEST(Ssim, AgreesWithTheDefinition) {
    uint32_t seed = 0;
    for (const Extent2D extent : {Extent2D{1, 1}, {7, 13}, {8, 8}, {24, 5}, {33, 41}}) {
        for (const double density : {0.05, 0.6, 1.0}) {
            const Image<float> x = random_picture(extent, ++seed), y = random_picture(extent, ++seed);
            const Image<uint8_t> mask = random_mask(extent, ++seed, density);
            EXPECT_NEAR(ssim_of(x, y, mask), reference::ssim(x, y, mask), kTolerance) << extent << ' ' << density;
        }
    }
}

TEST(Ssim, CountsUnfilledPixelsAsZero) {
    const Extent2D extent{29, 35};
    const Image<uint8_t> region = random_mask(extent, 1, 0.8), filled = both(region, random_mask(extent, 2, 0.5));
    const std::vector truth = {random_picture(extent, 3), random_picture(extent, 4)};
    const std::vector run = {random_picture(extent, 5), random_picture(extent, 6)};
    double over_filled = 0, over_region = 0;
    for (size_t channel = 0; channel < truth.size(); ++channel) {
        const Image<float> with_zeros = picture_of<float>(
            extent, [&](uint32_t x, uint32_t y) { return filled.at(x, y) ? run[channel].at(x, y) : 0; });
        over_filled += reference::ssim(truth[channel], run[channel], filled) / 2;
        over_region += reference::ssim(truth[channel], with_zeros, region) / 2;
    }
    const SsimScores scores = ssim(truth, run, region, filled);
    EXPECT_NEAR(scores.filled.value(), over_filled, kTolerance);
    EXPECT_NEAR(scores.all, over_region, kTolerance);
}

TEST(Ssim, WithoutFilledPixelsHasNoValueOverThem) {
    const Extent2D extent{12, 12};
    const Image<float> truth(extent, 1.0f), run(extent, 1.0f);
    const SsimScores scores = ssim({&truth, 1}, {&run, 1}, full(extent), Image<uint8_t>(extent));
    EXPECT_FALSE(scores.filled);
    EXPECT_NEAR(scores.all, 1e-4 / (1 + 1e-4), kTolerance);
}

TEST(Ssim, DoesNotLookOutsideTheMasks) {
    const Extent2D extent{20, 16};
    Image<float> truth = random_picture(extent, 1), run = random_picture(extent, 2);
    const Image<uint8_t> region = random_mask(extent, 3, 0.7), filled = both(region, random_mask(extent, 4, 0.7));
    const SsimScores expected = ssim({&truth, 1}, {&run, 1}, region, filled);
    for (size_t i = 0; i < extent.area(); ++i) {
        if (!region.pixels()[i]) truth.pixels()[i] = std::numeric_limits<float>::quiet_NaN();
        if (!filled.pixels()[i]) run.pixels()[i] = std::numeric_limits<float>::quiet_NaN();
    }
    const SsimScores scores = ssim({&truth, 1}, {&run, 1}, region, filled);
    EXPECT_EQ(scores.filled, expected.filled);
    EXPECT_EQ(scores.all, expected.all);
}

}  // namespace
}  // namespace patina::eval::ssim_test
