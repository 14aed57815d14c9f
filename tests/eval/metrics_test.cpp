#include "tools/eval/metrics.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "tests/eval/pictures.h"
#include "tools/eval/pixel_errors.h"

namespace patina::eval::metrics_test {
namespace {

using test::random_picture;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr Extent2D kExtent{40, 25};

/// Three channels of truth, all of them region and filled, the run being equal.
ObjectPictures perfect() {
    ObjectPictures pictures{Image<uint8_t>(kExtent, 1), Image<uint8_t>(kExtent, 1), {}, {}, {}};
    for (uint32_t seed = 0; seed < 3; ++seed) pictures.truth.push_back(random_picture(kExtent, seed, 0.2f, 0.8f));
    pictures.run = pictures.truth;
    return pictures;
}

TEST(Compare, PerfectPicturesHaveNoError) {
    const Comparison comparison = compare(perfect());
    for (const Scores& scores : {comparison.filled.value(), comparison.all}) {
        EXPECT_EQ(scores.mad, 0);
        EXPECT_EQ(scores.rmse, 0);
        EXPECT_EQ(scores.psnr_db, kInfinity);
        EXPECT_DOUBLE_EQ(scores.ssim, 1);
    }
    EXPECT_EQ(comparison.coverage, 1);
}

TEST(Compare, AConstantOffsetIsMadAndRmse) {
    ObjectPictures pictures = perfect();
    for (Image<float>& channel : pictures.run) {
        for (float& value : channel.pixels()) value -= 0.1f;
    }
    const Scores scores = compare(pictures).filled.value();
    EXPECT_NEAR(scores.mad, 0.1, 1e-6);
    EXPECT_NEAR(scores.rmse, 0.1, 1e-6);
    EXPECT_NEAR(scores.psnr_db, 20, 1e-4);
    EXPECT_LT(scores.ssim, 1);
}

TEST(Compare, OneWrongChannelCountsAThird) {
    ObjectPictures pictures = perfect();
    for (float& value : pictures.run[1].pixels()) value += 0.3f;
    const Scores scores = compare(pictures).filled.value();
    EXPECT_NEAR(scores.mad, 0.1, 1e-6);
    EXPECT_NEAR(scores.rmse, 0.3 / std::sqrt(3), 1e-6);
}

TEST(Compare, UnfilledPixelsCountAsZero) {
    ObjectPictures pictures{Image<uint8_t>(kExtent, 1), Image<uint8_t>(kExtent, 1), {}, {}, {}};
    pictures.truth.emplace_back(kExtent, 0.5f);
    pictures.run = pictures.truth;
    for (size_t i = 0; i < 100; ++i) {
        pictures.filled.pixels()[i * 7] = 0;
        pictures.run[0].pixels()[i * 7] = std::numeric_limits<float>::quiet_NaN();
    }
    const Comparison comparison = compare(pictures);
    EXPECT_DOUBLE_EQ(comparison.coverage, 0.9);
    EXPECT_EQ(comparison.filled->rmse, 0);
    EXPECT_DOUBLE_EQ(comparison.all.mad, 0.1 * 0.5);
    EXPECT_DOUBLE_EQ(comparison.all.rmse, std::sqrt(0.1 * 0.25));
    EXPECT_LT(comparison.all.ssim, 0.5);
}

TEST(Compare, LeavingPixelsOutNeverPaysWhereTheRunIsOffByLessThanTheTruth) {
    ObjectPictures pictures = perfect();
    for (Image<float>& channel : pictures.run) {
        for (float& value : channel.pixels()) value *= 1.5f;
    }
    Scores before = compare(pictures).all;
    for (const size_t pixel : {0u, 17u, 140u, 512u, 999u}) {
        pictures.filled.pixels()[pixel] = 0;
        const Scores after = compare(pictures).all;
        EXPECT_GT(after.mad, before.mad);
        EXPECT_GT(after.rmse, before.rmse);
        EXPECT_LT(after.psnr_db, before.psnr_db);
        EXPECT_LT(after.ssim, before.ssim);
        before = after;
    }
}

TEST(Compare, OnlyTheRegionCounts) {
    ObjectPictures pictures = perfect();
    for (size_t i = 0; i < 300; ++i) {
        pictures.region.pixels()[i] = pictures.filled.pixels()[i] = 0;
        pictures.run[0].pixels()[i] = 1000;
    }
    const Comparison comparison = compare(pictures);
    EXPECT_EQ(comparison.coverage, 1);
    EXPECT_EQ(comparison.filled->rmse, 0);
    EXPECT_DOUBLE_EQ(comparison.filled->ssim, 1);
}

TEST(Compare, WithoutFilledPixelsOnlyTheZeroVariantHasValues) {
    ObjectPictures pictures = perfect();
    pictures.filled = Image<uint8_t>(kExtent);
    const Comparison comparison = compare(pictures);
    EXPECT_EQ(comparison.coverage, 0);
    EXPECT_FALSE(comparison.filled);
    EXPECT_NEAR(comparison.all.mad, mean_over(pictures.region, pictures.truth)->x, 0.02);
    EXPECT_FALSE(mean_over(pictures.filled, pictures.run));
}

TEST(Compare, WhatWasSeenIsScoredApart) {
    ObjectPictures pictures = perfect();
    pictures.seen = Image<uint8_t>(kExtent);
    for (size_t i = 0; i < pictures.seen.pixels().size(); ++i) {
        pictures.seen.pixels()[i] = i % kExtent.width < 20;
        if (!pictures.seen.pixels()[i]) pictures.run[0].pixels()[i] += 0.3f;
    }
    const Comparison comparison = compare(pictures);
    EXPECT_NEAR(comparison.all.mad, 0.05, 1e-6);
    EXPECT_NEAR(comparison.filled->mad, 0.05, 1e-6);
    EXPECT_EQ(comparison.seen->mad, 0);
    EXPECT_DOUBLE_EQ(comparison.seen->ssim, 1);
    pictures.seen = Image<uint8_t>(kExtent);
    for (size_t i = 0; i < kSmallestRegion - 1; ++i) pictures.seen.pixels()[i] = 1;
    EXPECT_FALSE(compare(pictures).seen);
}

TEST(Compare, SrgbHasAPsnrOfItsOwn) {
    ObjectPictures pictures = perfect();
    pictures.is_rgb = true;
    EXPECT_EQ(compare(pictures).all.psnr_srgb_db, kInfinity);
    for (size_t c = 0; c < 3; ++c) {
        pictures.truth[c] = Image<float>(kExtent, 0.2140f);  // 0.5 in sRGB
        pictures.run[c] = Image<float>(kExtent, 0.3185f);    // 0.6
    }
    EXPECT_NEAR(*compare(pictures).all.psnr_srgb_db, 20, 0.01);
    EXPECT_NEAR(compare(pictures).all.psnr_db, -20 * std::log10(0.1045), 0.01);
}

TEST(AveragesOf, HasTheLastTenthOfTheFramesBesideAll) {
    std::vector<FramePoint> frames(11);
    for (uint32_t i = 0; i < 11; ++i) {
        frames[i].frame = 10 * i;
        frames[i].comparison.all.mad = i;
    }
    const Averages averages = averages_of(frames);
    EXPECT_DOUBLE_EQ(averages.mean.all.mad, 5);
    EXPECT_DOUBLE_EQ(averages.at_end.all.mad, 9.5) << "a tenth of 11, rounded up";
    EXPECT_FALSE(averages.mean.filled);
}

TEST(MeanOver, ScalarsFillAllChannels) {
    const Image<float> scalar(kExtent, 0.25f);
    EXPECT_EQ(mean_over(Image<uint8_t>(kExtent, 1), {&scalar, 1}), glm::dvec3(0.25));
}

TEST(MeanOf, CapsInfinitePsnrUnlessAllAre) {
    const Scores perfect_scores{0, 0, kInfinity, 1, {}}, other{0.1, 0.1, 20, 0.5, {}}, tiny{1e-8, 1e-8, 160, 1, {}};
    EXPECT_EQ(mean_of(std::vector{perfect_scores, other}).psnr_db, (kPsnrCap_db + 20) / 2);
    EXPECT_EQ(mean_of(std::vector{tiny, other}).psnr_db, (kPsnrCap_db + 20) / 2);
    EXPECT_EQ(mean_of(std::vector{perfect_scores, perfect_scores}).psnr_db, kInfinity);
    EXPECT_DOUBLE_EQ(mean_of(std::vector{perfect_scores, other}).ssim, 0.75);
}

TEST(MeanOf, LeavesOutWhatIsNotThere) {
    const Scores scores{0.2, 0.2, 14, 0.5, {}};
    const Comparison seen{1, scores, scores, scores}, unseen{0, {0.6, 0.6, 4, 0.1, {}}, {}, {}};
    const Comparison mean = mean_of(std::vector{seen, unseen});
    EXPECT_DOUBLE_EQ(mean.coverage, 0.5);
    EXPECT_DOUBLE_EQ(mean.filled->mad, 0.2);
    EXPECT_DOUBLE_EQ(mean.all.mad, 0.4);
    EXPECT_FALSE(mean_of(std::vector{unseen}).filled);
}

TEST(PixelErrorSum, HasMeanRmseAndPercentiles) {
    PixelErrorSum sum;
    for (int i = 1; i <= 1000; ++i) sum.add(static_cast<float>(i) * 0.01f);
    const PixelErrors errors = sum.spread(4000).value();
    EXPECT_EQ(errors.pixels, 1000u);
    EXPECT_EQ(errors.coverage, 0.25);
    EXPECT_NEAR(errors.mean, 5.005, 1e-5);
    EXPECT_NEAR(errors.rmse, std::sqrt(1001 * 2001 / 6.0) * 0.01, 1e-5);
    EXPECT_NEAR(errors.median, 5, 5 * 5e-4);
    EXPECT_NEAR(errors.p90, 9, 9 * 5e-4);
}

TEST(PixelErrorSum, OfNothingIsEmpty) {
    EXPECT_FALSE(PixelErrorSum().spread(100));
    PixelErrorSum zeros;
    zeros.add(0);
    zeros.add(-0.0f);
    EXPECT_EQ(zeros.spread(2)->median, 0);
    EXPECT_EQ(zeros.spread(2)->p90, 0);
}

}  // namespace
}  // namespace patina::eval::metrics_test
