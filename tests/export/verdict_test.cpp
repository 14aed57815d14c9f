#include "tools/report/verdict.h"

#include <gmock/gmock.h>

#include "tests/export/full_summary.h"

namespace patina::verdict_test {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

SegmentSummary segment(uint32_t id, float confidence) {
    return {id, "", {glm::vec3(0.5f), WardGloss{glm::vec3(0.1f), 0.2f, confidence}, 10, 10, 0.5f}};
}

TrackedFrame tracked(uint32_t index, TrackingState state) {
    TrackedFrame frame{index, {}};
    frame.report.state = state;
    return frame;
}

TEST(Verdict, CountsGlossThatWasNotObserved) {
    RunSummary summary = test::full_summary();
    summary.lamps = {{{0, 2, 0}, {1, 1, 1}, 0}};
    summary.segments = {segment(1, 0.9f), segment(2, 0.1f), segment(3, 0.2f), segment(4, 0.2f)};
    summary.segments.back().reflectance.voxels = 3;  // too small to be an object
    const Verdict verdict = verdict_of(summary);
    EXPECT_THAT(verdict.good, Contains("Gloss was observed on 1 of 3 objects."));
    EXPECT_THAT(verdict.unknown, Contains(HasSubstr("Gloss of 2 of 3 objects was not observed: walk round them")));
    EXPECT_THAT(verdict.good, Contains("The diffuse albedo of all 3 objects is known."));
}

TEST(Verdict, SaysWhereTheAlbedoIsMissing) {
    RunSummary summary = test::full_summary();
    summary.segments = {segment(1, 0.9f), segment(2, 0.9f)};
    summary.segments[0].reflectance.kd.reset();
    const Verdict verdict = verdict_of(summary);
    EXPECT_THAT(verdict.unknown, Contains(HasSubstr("diffuse albedo of 1 of 2 objects was not observed")));
    EXPECT_THAT(verdict.unknown, Not(Contains(HasSubstr("Gloss"))));
}

TEST(Verdict, WithoutLampsNobodyIsSentRoundTheObjects) {
    RunSummary summary = test::full_summary();
    summary.segments = {segment(1, 0.1f)};
    EXPECT_THAT(verdict_of(summary).unknown, testing::ElementsAre(HasSubstr("No lamp is known")));
    summary.materials_missing = "no lights were given";
    EXPECT_THAT(verdict_of(summary).unknown, testing::ElementsAre("no lights were given"));
}

TEST(Verdict, LostFramesAreNoSuccess) {
    RunSummary summary = test::full_summary();
    summary.tracking = {tracked(0, TrackingState::kTracking), tracked(1, TrackingState::kWeak)};
    EXPECT_THAT(verdict_of(summary).good, Contains("The camera was tracked in every frame."));
    summary.tracking.push_back(tracked(2, TrackingState::kLost));
    EXPECT_THAT(verdict_of(summary).unknown, Contains(HasSubstr("lost in 1 of 3 frames")));
    summary.frames.used = 200;
    EXPECT_THAT(verdict_of(summary).unknown, Contains(HasSubstr("200 of 300 frames were used: what")));
}

TEST(Verdict, TextureAndScoreHaveToBeGoodEnough) {
    RunSummary summary = test::full_summary();
    summary.totals = {{"texels that a picture showed", 90}, {"texels that no picture showed", 10}};
    summary.held_out.emplace();
    summary.held_out->pictures = 7;
    summary.held_out->mean_color.psnr_srgb_db = 27.26;
    Verdict verdict = verdict_of(summary);
    EXPECT_THAT(verdict.good, Contains("90 % of the surface has its colour from pictures."));
    EXPECT_THAT(verdict.good, Contains(HasSubstr("with 27.3 dB (median of 7).")));
    summary.totals[0].second = 20;
    summary.held_out->mean_color.psnr_srgb_db = 18;
    verdict = verdict_of(summary);
    EXPECT_THAT(verdict.unknown, Contains(HasSubstr("67 % of the surface has its colour from pictures; the rest")));
    EXPECT_THAT(verdict.unknown, Contains(HasSubstr("with 18.0 dB (median of 7); 25 dB are good.")));
}

TEST(Verdict, OfNothingIsEmpty) {
    const Verdict verdict = verdict_of({});
    EXPECT_THAT(verdict.good, IsEmpty());
    EXPECT_THAT(verdict.unknown, IsEmpty());
}

}  // namespace
}  // namespace patina::verdict_test
