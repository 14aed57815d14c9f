#include "reconstruction/session/shortfalls.h"

#include <gmock/gmock.h>

#include "tools/program/outcome.h"

namespace patina::shortfalls_test {
namespace {

using enum TrackingState;

std::vector<TrackedFrame> tracked(const std::vector<TrackingState>& states) {
    std::vector<TrackedFrame> frames;
    for (uint32_t i = 0; i < states.size(); ++i) {
        frames.push_back({10 + i, {}});
        frames.back().report.state = states[i];
        frames.back().report.reason = text("reason ", 10 + i);
    }
    return frames;
}

TEST(LostForGood, IsALossAtTheEndAlone) {
    EXPECT_EQ(lost_for_good({}), "");
    EXPECT_EQ(lost_for_good(tracked({kTracking, kTracking})), "");
    EXPECT_EQ(lost_for_good(tracked({kTracking, kLost, kLost, kTracking})), "");
    EXPECT_EQ(lost_for_good(tracked({kTracking, kWeak, kWeak})), "");
    EXPECT_EQ(lost_for_good(tracked({kTracking, kLost, kTracking, kWeak, kLost})),
              "tracking was lost at frame 13 and not found again: reason 13; the last 2 frames are left out");
    EXPECT_EQ(lost_for_good(tracked({kLost})),
              "tracking was lost at frame 10 and not found again: reason 10; the last frame is left out");
}

TEST(Outcome, IsShortOnceAnythingIs) {
    tools::Outcome outcome;
    EXPECT_EQ(outcome.exit_code(), 0);
    outcome.fall_short("a");
    outcome.fall_short("b");
    outcome.fall_short("a");
    EXPECT_EQ(outcome.exit_code(), 3);
    EXPECT_THAT(outcome.shortfalls(), ::testing::ElementsAre("a", "b"));
}

}  // namespace
}  // namespace patina::shortfalls_test
