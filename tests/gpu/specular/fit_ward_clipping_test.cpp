// The Ward fit where channels are clipped, and what it keeps from one fit to the next.
#include <algorithm>

#include "passes/specular/fit_ward.h"
#include "tests/gpu/specular/fit_ward_rig.h"

namespace patina::fit_ward_clipping_test {
namespace {

using reference::Ward;

TEST_F(FitWardTest, ClippedChannelsAndWildObservationsChangeLittle) {
    const Ward truth{{}, {0.1, 0.12, 0.14}, 0.12};
    std::vector<FilledRecord> records = clipped(sphere(1, truth), 0.6f);
    for (FilledRecord& record : records) {
        for (FilledObservation& seen : record.observations)
            if (random_() % 20 == 0) seen.rgb *= 3.0f;
    }
    fill(records);
    const glm::vec4 got = fit({1}, 25)[1].ks_alpha;
    EXPECT_LT(max_of(glm::abs(glm::dvec3(got) - truth.ks)), 0.01);
    EXPECT_NEAR(got.w, truth.alpha, 0.01);
}

TEST_F(FitWardTest, TheFlanksOfClippedHighlightsTellTheirPeaks) {
    // Peaks are many times as bright as what the camera records. Taken as recorded they would hold ks down to 0.12.
    const Ward truth{{}, {0.3, 0.25, 0.2}, 0.06};
    const std::vector<FilledRecord> records = clipped(sphere(1, truth, 200), 0.6f);
    size_t peaks = 0;
    for (const FilledRecord& record : records)
        for (const FilledObservation& seen : record.observations) peaks += seen.clipped[0];
    ASSERT_GT(peaks, 100u);
    fill(records);
    for (const uint32_t times : {2u, 20u}) {
        const glm::vec4 got = fit({1}, times)[1].ks_alpha;
        EXPECT_LT(max_of(glm::abs(glm::dvec3(got) - truth.ks) / truth.ks), 0.02) << times;
        EXPECT_NEAR(got.w, truth.alpha, 0.01 * truth.alpha) << times;
    }
}

TEST_F(FitWardTest, VoxelsWhoseViewsAreAllClippedShowAPeak) {
    // Alone they tell no ks, but that the peak was looked for: without them, what flanks tell would count for less.
    const Ward truth{{}, {0.3, 0.25, 0.2}, 0.06};
    std::vector<FilledRecord> records = clipped(sphere(1, truth, 60), 0.4f);
    const auto is_clipped = [](const FilledObservation& seen) {
        return seen.clipped[0] && seen.clipped[1] && seen.clipped[2];
    };
    size_t peaks = 0;
    for (FilledRecord& record : records) {
        if (std::ranges::none_of(record.observations, is_clipped)) continue;
        std::erase_if(record.observations, [&](const FilledObservation& seen) { return !is_clipped(seen); });
        const FilledObservation peak = record.observations.front();
        record.observations.resize(std::max<size_t>(record.observations.size(), gpu::kFitLeastObservations), peak);
        ++peaks;
    }
    ASSERT_GT(peaks, 6u);
    fill(records);
    const gpu::WardFit got = fit({1})[1];
    EXPECT_LT(max_of(glm::abs(glm::dvec3(got.ks_alpha) - truth.ks) / truth.ks), 0.06) << "0.2, did they not count";
    EXPECT_NEAR(got.ks_alpha.w, truth.alpha, 0.03 * truth.alpha) << "9 % more, did they not count";
    expect_agreement(got, reference_fits(records).front(), 2e-3, 2e-4, 0.03);
}

TEST_F(FitWardTest, LaterFitsAgreeWithTheReferenceOnClippedAndWildObservations) {
    const Ward truth{{}, {0.3, 0.25, 0.2}, 0.06};
    std::vector<FilledRecord> records = sphere(1, truth, 15);
    std::normal_distribution<float> noise(0, 0.03f);
    for (FilledRecord& record : records) {
        for (FilledObservation& seen : record.observations) {
            seen.rgb *= 1 + noise(random_);
            if (random_() % 15 == 0) seen.rgb *= 1.7f;
        }
    }
    records = clipped(records, 0.2f);
    fill(records);
    const std::vector<ReferenceFit> want = reference_fits(records, 4);
    EXPECT_GT(max_of(glm::abs(want[1].material.ks - want[0].material.ks)), 0.015)
        << "clipped channels count from the second on";
    // Alpha is known to less than a step of the shader's grid.
    for (const ReferenceFit& each : want) expect_agreement(fit({1})[1], each, 2e-3, 1e-4, 3e-3);
}

TEST_F(FitWardTest, RoughNormalsAndClippedPeaksTellKs) {
    // Normals are off by some degrees, as those of a volume, and peaks are clipped. Did dark observations count for
    // more than bright ones, those that miss a highlight would say that it is weaker: ks would be 0.105.
    const Ward truth{{}, glm::dvec3(0.15), 0.1};
    std::vector<FilledRecord> records = sphere(1, truth);
    std::normal_distribution<float> error(0, 0.03f);
    for (FilledRecord& record : records) {
        record.normal = glm::normalize(record.normal + glm::vec3(error(random_), error(random_), error(random_)));
    }
    fill(clipped(records, 0.8f));
    const glm::vec4 got = fit({1}, 25)[1].ks_alpha;
    EXPECT_LT(max_of(glm::abs(glm::dvec3(got) - truth.ks)), 0.025);
    EXPECT_NEAR(got.w, truth.alpha, 0.01);
}

TEST_F(FitWardTest, ClippedPeaksWhereNormalsHaveNoneAreNoOutliers) {
    // A sharp gloss on normals that are off by more than its width: most peaks are where none is predicted, at least
    // ten times as bright as the rest. As outliers they would count less with every fit, until ks is where none are
    // told.
    const Ward truth{{}, glm::dvec3(0.12), 0.06};
    std::vector<FilledRecord> records = sphere(1, truth, 200);
    std::normal_distribution<float> error(0, 0.06f);
    for (FilledRecord& record : records) {
        record.normal = glm::normalize(record.normal + glm::vec3(error(random_), error(random_), error(random_)));
    }
    fill(clipped(records, 0.8f));
    const glm::vec4 got = fit({1}, 60)[1].ks_alpha;
    EXPECT_GT(got.r, 0.3 * truth.ks.r);
}

TEST_F(FitWardTest, AChannelThatAllViewsClipCostsTheOthersNothing) {
    const Ward truth{{}, glm::dvec3(0.1), 0.15};
    std::vector<FilledRecord> records = sphere(1, truth);
    for (FilledRecord& record : records) {
        record.observations.resize(20);
        for (FilledObservation& seen : record.observations) {
            seen.clipped[2] = true;
            seen.rgb.b = 1;
        }
    }
    fill(records);
    const gpu::WardFit first = fit({1}, 1)[1];
    ASSERT_GT(first.confidence, 0.5f);
    EXPECT_EQ(first.color2_weight.w, 2.0f * 20 * kVoxels) << "two channels of each observation";
    const gpu::WardFit later = fit({1}, 4)[1];
    EXPECT_NEAR(later.color2_weight.w, 4.347f * first.color2_weight.w, 0.01f * first.color2_weight.w)
        << "0.93 of them are kept each time";
    EXPECT_EQ(later.color2_weight.b, 0);
    EXPECT_NEAR(later.ks_alpha.r, 0.1, 2e-3);
    EXPECT_NEAR(later.ks_alpha.g, 0.1, 2e-3);
    EXPECT_NEAR(later.ks_alpha.w, 0.15, 2e-3);
}

TEST_F(FitWardTest, WhatWasSummedUpOfAForgottenObjectDoesNotCount) {
    const std::vector<FilledRecord> records = clipped(sphere(1, {{}, glm::dvec3(0.3), 0.08}), 0.5f);
    fill(records);
    const gpu::WardFit first = fit({1})[1];
    EXPECT_NE(fit({1}, 3)[1].ks_alpha, first.ks_alpha);
    graph::FrameGraph frame = runner().begin();
    const gpu::WardFit nothing{};
    frame.keep(frame.upload_bytes(table_.import(frame).fits, sizeof(nothing), std::as_bytes(std::span(&nothing, 1)),
                                  false));  // as specular/choose_segments.comp forgets label 1
    run(std::move(frame));
    const gpu::WardFit again = fit({1})[1];
    EXPECT_EQ(again.ks_alpha, first.ks_alpha);
    EXPECT_EQ(again.color2_weight, first.color2_weight);
    EXPECT_EQ(again.confidence, first.confidence);
}

}  // namespace
}  // namespace patina::fit_ward_clipping_test
