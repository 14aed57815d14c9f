// Intervals of materials whose sums are made up, and of segments that were fitted.
#include "passes/specular/bound_materials.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "shared/reflectance/reflectance.h"
#include "tests/gpu/specular/fit_ward_rig.h"
#include "tests/reference/specular/bound_materials.h"

namespace patina::bound_materials_test {
namespace {

using reference::BoundedMaterial;
using reference::BoundedSegment;

constexpr std::array kProbabilities = {0.5, 0.8, 0.9, 0.95};
constexpr double kAt90 = 2.9200;  // of Student's distribution with two degrees of freedom, from a table

double alpha_of(size_t step) { return 0.6 * std::exp2(-static_cast<double>(step) / 8); }

/// Nothing was observed of it.
BoundedSegment unseen() {
    BoundedSegment segment;
    for (size_t a = 0; a < gpu::kFitAlphas; ++a) segment.sums.push_back({alpha_of(a), {}, {}, 0});
    segment.deviation = 0.5;
    segment.ks = glm::dvec3(0.04);
    segment.alpha = 0.2;
    return segment;
}

/// A highlight of this ks, which no alpha but one explains.
BoundedSegment sharp(size_t step, glm::dvec3 ks) {
    BoundedSegment segment = unseen();
    for (reference::AlphaSums& sums : segment.sums) sums.seen = 50;
    segment.sums[step].lobe2 = glm::dvec3(1e7);
    segment.sums[step].product = 1e7 * ks;
    segment.ks = ks;
    segment.alpha = alpha_of(step);
    segment.fit_confidence = 1;
    segment.kd = segment.squares_kd = glm::dvec3(0.5, 0.25, 0.125);
    return segment;
}

class BoundMaterials : public FitWardTest {
  protected:
    std::vector<gpu::MaterialBounds> bounds_of(const WardFitIds& fits, graph::BufferId albedo,
                                               graph::FrameGraph& frame) {
        const graph::Readback read = frame.read_back(add_bound_materials(frame, {table_, fits, albedo}));
        run(std::move(frame));
        return read.as<gpu::MaterialBounds>();
    }

    /// By label, from 1 on.
    std::vector<gpu::MaterialBounds> bound(const std::vector<BoundedSegment>& segments) {
        std::vector<gpu::WardFit> fits(kLabels);
        std::vector<gpu::FitCurve> curves(kLabels * gpu::kFitAlphas);
        std::vector<gpu::SegmentAlbedo> albedo(kLabels);
        for (size_t i = 0; i < segments.size(); ++i) {
            const BoundedSegment& segment = segments[i];
            gpu::WardFit& fit = fits[i + 1];
            fit.ks_alpha = glm::vec4(segment.ks, segment.alpha);
            fit.confidence = static_cast<float>(segment.fit_confidence);
            fit.deviation = static_cast<float>(segment.deviation);
            fit.estimates = 1;
            fit.light2 = segment.squares_kd ? glm::vec4(2) : glm::vec4(0);
            fit.diffuse = glm::vec4(2.0 * segment.squares_kd.value_or(glm::dvec3(0)), 0);
            for (size_t a = 0; a < gpu::kFitAlphas; ++a) {
                const reference::AlphaSums& sums = segment.sums[a];
                const double scale = 1 / (4 * 3.14159265358979 * sums.alpha * sums.alpha);
                gpu::FitSums& kept = curves[(i + 1) * gpu::kFitAlphas + a].sums;
                kept.lobe2 = glm::vec4(sums.lobe2 / (scale * scale), sums.seen);
                kept.product = glm::vec4(sums.product / scale, 0);
            }
            albedo[i + 1] = albedo_of(segment.kd);
        }
        graph::FrameGraph frame = runner().begin();
        const WardFitIds ids{
            frame.upload<gpu::WardFit>("fits", fits), frame.upload<gpu::FitCurve>("curves", curves), {}, {}};
        const graph::BufferId sums = frame.upload<gpu::SegmentAlbedo>("albedo", albedo);
        return bounds_of(ids, sums, frame);
    }

    /// Of 1000 certain records.
    static gpu::SegmentAlbedo albedo_of(const std::optional<glm::dvec3>& kd) {
        const auto weight = static_cast<uint32_t>(1000 * gpu::kCertaintySteps);
        gpu::SegmentAlbedo sums{glm::uvec4(0, 0, 0, 1000), glm::uvec4(0, 0, 0, 20000)};
        if (!kd) return sums;
        sums.weight = glm::uvec4(glm::uvec3(weight), 20000);
        sums.kd = glm::uvec4(glm::round(*kd * double{gpu::kAlbedoSteps} * double(weight)), 1000);
        return sums;
    }
};

std::array<double, 7> low_of(const gpu::MaterialBounds& bounds) {
    const glm::vec4 gloss = bounds.ks_alpha_low, kd = bounds.kd_low;
    return {gloss.r, gloss.g, gloss.b, gloss.w, kd.r, kd.g, kd.b};
}

std::array<double, 7> high_of(const gpu::MaterialBounds& bounds) {
    const glm::vec4 gloss = bounds.ks_alpha_high, kd = bounds.kd_high;
    return {gloss.r, gloss.g, gloss.b, gloss.w, kd.r, kd.g, kd.b};
}

TEST_F(BoundMaterials, OfOneSharpHighlightHaveTheWidthsOfTheModelsErrors) {
    const glm::dvec3 ks(0.4, 0.2, 0.1);
    const size_t step = 4;
    const gpu::MaterialBounds got = bound({sharp(step, ks)})[gpu::kBoundsLevels + 2];
    const double alpha = alpha_of(step), blur = std::pow(0.048 / alpha, 2);
    EXPECT_NEAR(got.ks_alpha_low.w, alpha * std::exp2(-kAt90 * std::hypot(0.04, blur)), 1e-4);
    EXPECT_NEAR(got.ks_alpha_high.w, alpha * std::exp2(kAt90 * 0.04), 1e-4);
    for (glm::length_t c = 0; c < 3; ++c) {
        // Of 1e7 observations 50 count as one: noise is a hundredth of the errors of models.
        EXPECT_NEAR(got.ks_alpha_low[c] + 0.003, (ks[c] + 0.003) * std::exp(-kAt90 * 0.02), 0.02 * ks[c]) << c;
        EXPECT_NEAR(got.ks_alpha_high[c] + 0.003, (ks[c] + 0.003) * std::exp(kAt90 * std::hypot(0.035, 0.6 * blur)),
                    0.02 * ks[c])
            << c;
    }
    // Both estimates of kd agree, and the highlight is known: what is left is the light's 1 %, and a little of ks.
    EXPECT_NEAR(got.kd_low.r, 0.5 * std::exp(-kAt90 * 0.01), 2e-3);
    EXPECT_NEAR(got.kd_high.r, 0.5 * std::exp(kAt90 * 0.01), 2e-3);
    EXPECT_GT(got.kd_low.w, 0.9f) << "sure";
}

TEST_F(BoundMaterials, OfAHighlightThatNobodySawAreWide) {
    const gpu::MaterialBounds got = bound({unseen()})[gpu::kBoundsLevels + 2];
    for (glm::length_t c = 0; c < 3; ++c) {
        EXPECT_NEAR(got.ks_alpha_high[c] + 0.003, 0.043 * std::exp(kAt90 * 0.47), 1e-4);
        EXPECT_LT(got.ks_alpha_low[c], 1e-6) << "there may be none";
        EXPECT_EQ(got.kd_low[c], 0.0f) << "not known";
        EXPECT_EQ(got.kd_high[c], 1.0f);
    }
    EXPECT_LT(got.ks_alpha_low.w, 0.04);
    EXPECT_GT(got.ks_alpha_high.w, 0.5);
    BoundedSegment claimed = unseen();
    claimed.fit_confidence = 0.95;
    EXPECT_LT(bound({claimed})[gpu::kBoundsLevels].kd_low.w, 0.5f) << "whatever the fit says";
}

TEST_F(BoundMaterials, AreWiderWhereTwoEstimatesOfKdDisagree) {
    BoundedSegment doubtful = sharp(4, glm::dvec3(0.2));
    doubtful.squares_kd = 1.05 * *doubtful.kd;
    const auto got = bound({sharp(4, glm::dvec3(0.2)), doubtful});
    const gpu::MaterialBounds &sure = got[gpu::kBoundsLevels + 2], &doubted = got[2 * gpu::kBoundsLevels + 2];
    EXPECT_NEAR(doubted.kd_high.r, 0.5 * std::exp(kAt90 * 1.5 * std::log(1.05)), 0.02);
    EXPECT_GT(doubted.ks_alpha_high.r, sure.ks_alpha_high.r);
    EXPECT_LT(doubted.ks_alpha_low.w, sure.ks_alpha_low.w);
}

TEST_F(BoundMaterials, AgreeWithTheReference) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> uniform;
    std::vector<BoundedSegment> segments{unseen(), sharp(20, {0.02, 0.03, 0.04})};
    while (segments.size() < kLabels - 1) {
        BoundedSegment segment = unseen();
        const glm::dvec3 ks(0.3 * uniform(random), 0.3 * uniform(random), 0.01);
        const double center = 39 * uniform(random), width = 1 + 8 * uniform(random);
        const double lobe2 = std::pow(10, 3 + 3 * uniform(random));
        for (size_t a = 0; a < gpu::kFitAlphas; ++a) {
            const double fits = std::exp(-std::pow((static_cast<double>(a) - center) / width, 2));
            segment.sums[a].lobe2 = glm::dvec3(lobe2);
            segment.sums[a].product = lobe2 * fits * ks;
            segment.sums[a].seen = 0.01 + std::max(30 - static_cast<double>(a), 0.0) * uniform(random);
        }
        segment.deviation = 2 * uniform(random);
        segment.ks = 0.9 * ks;
        segment.alpha = alpha_of(static_cast<size_t>(center));
        segment.fit_confidence = uniform(random);
        if (segments.size() % 3 > 0) segment.kd = glm::dvec3(uniform(random), 0.3, 0.002);
        if (segments.size() % 3 > 1) segment.squares_kd = *segment.kd * (0.8 + 0.4 * uniform(random));
        segments.push_back(segment);
    }
    const auto got = bound(segments);
    for (size_t i = 0; i < segments.size(); ++i) {
        for (size_t level = 0; level < kProbabilities.size(); ++level) {
            const BoundedMaterial want = reference::bound_material(segments[i], kProbabilities[level]);
            const gpu::MaterialBounds& bounds = got[(i + 1) * gpu::kBoundsLevels + level];
            const auto low = low_of(bounds), high = high_of(bounds);
            for (size_t k = 0; k < 7; ++k) {
                // The table has steps of 7e-4 of a factor, and 32-bit floats keep as much of a likelihood's logarithm.
                EXPECT_NEAR(low[k], want.low[k], 2e-3 * want.low[k] + 3e-4) << i << ' ' << level << ' ' << k;
                EXPECT_NEAR(high[k], want.high[k], 2e-3 * want.high[k] + 3e-4) << i << ' ' << level << ' ' << k;
            }
            EXPECT_NEAR(bounds.kd_low.w, want.confidence, 2e-3) << i;
        }
    }
}

TEST_F(BoundMaterials, OfFittedSegmentsHoldTheTruth) {
    const reference::Ward truth{{}, glm::dvec3(0.1), 0.15};
    fill(sphere(1, truth));
    fit({1}, 4);
    graph::FrameGraph frame = runner().begin();
    std::vector<gpu::SegmentAlbedo> albedo(kLabels);
    albedo[1] = albedo_of({});
    const graph::BufferId sums = frame.upload<gpu::SegmentAlbedo>("albedo", albedo);
    const auto bounds = bounds_of(table_.import(frame), sums, frame);
    for (uint32_t level = 0; level < gpu::kBoundsLevels; ++level) {
        const gpu::MaterialBounds& got = bounds[gpu::kBoundsLevels + level];
        for (glm::length_t c = 0; c < 3; ++c) {
            EXPECT_LE(got.ks_alpha_low[c], 0.1) << level;
            EXPECT_GE(got.ks_alpha_high[c], 0.1) << level;
        }
        EXPECT_LE(got.ks_alpha_low.w, truth.alpha) << level;
        EXPECT_GE(got.ks_alpha_high.w, truth.alpha) << level;
    }
}

}  // namespace
}  // namespace patina::bound_materials_test
