#include "tools/report/tracking_summary.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace patina::tracking_summary_test {
namespace {

using ::testing::HasSubstr;

TrackedFrame frame(uint32_t index, TrackingState state, const std::string& reason = "") {
    TrackedFrame tracked{index, {}};
    tracked.report.state = state;
    tracked.report.reason = reason;
    tracked.report.share = 0.75;
    return tracked;
}

const std::vector<TrackedFrame> kFrames = {
    frame(0, TrackingState::kTracking),         frame(1, TrackingState::kTracking),
    frame(3, TrackingState::kLost, "no <one>"), frame(4, TrackingState::kLost, "nor here"),
    frame(5, TrackingState::kWeak, "a wall"),   frame(6, TrackingState::kTracking)};

TEST(TrackingSummary, CountsStatesAndListsEveryFrame) {
    const nlohmann::ordered_json json = tracking_json(kFrames);
    EXPECT_EQ(json["tracking"], 3);
    EXPECT_EQ(json["weak"], 1);
    EXPECT_EQ(json["lost"], 2);
    ASSERT_EQ(json["frames"].size(), 6u);
    EXPECT_EQ(json["frames"][2]["index"], 3);
    EXPECT_EQ(json["frames"][2]["state"], "lost");
    EXPECT_EQ(json["frames"][2]["reason"], "no <one>");
    EXPECT_EQ(json["frames"][2]["share"], 0.75);
    EXPECT_FALSE(json["frames"][0].contains("reason"));
}

TEST(TrackingSummary, StretchesJoinFramesOfOneState) {
    const std::vector<TrackingStretch> stretches = stretches_of(kFrames);
    ASSERT_EQ(stretches.size(), 4u);
    EXPECT_EQ(stretches[1].first, 3u);
    EXPECT_EQ(stretches[1].last, 4u);
    EXPECT_EQ(stretches[1].state, TrackingState::kLost);
    EXPECT_EQ(stretches[1].reason, "no <one>");
    EXPECT_EQ(stretches[3].first, 6u);
}

TEST(TrackingSummary, TheTableEscapesReasonsAndIsEmptyWithoutFrames) {
    EXPECT_THAT(tracking_table(kFrames), HasSubstr("<td>lost</td><td>no &lt;one&gt;</td>"));
    EXPECT_EQ(tracking_table({}), "");
}

}  // namespace
}  // namespace patina::tracking_summary_test
