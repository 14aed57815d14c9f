#include "tools/report/live_summary.h"

#include <numeric>

#include <gmock/gmock.h>

namespace patina::live_summary_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

TEST(LiveSummary, PercentilesAreOfTheFramesThemselves) {
    std::vector<float> latencies_s(100);
    std::iota(latencies_s.rbegin(), latencies_s.rend(), 1.0f);  // 100, 99 .. 1
    for (float& latency : latencies_s) latency /= 1000;
    const LatencySummary latency = summarised(latencies_s);
    EXPECT_EQ(latency.frames, 100u);
    EXPECT_NEAR(latency.median_ms, 51, 1e-3);  // float seconds round at 1e-7 of them
    EXPECT_NEAR(latency.p95_ms, 95, 1e-3);     // 95 of 100 are at most this
    EXPECT_NEAR(latency.max_ms, 100, 1e-3);
    EXPECT_NEAR(summarised({0.25f}).p95_ms, 250, 1e-3);
    EXPECT_EQ(summarised({}).frames, 0u);
}

TEST(LiveSummary, TellsWhatARecordingBesideItHas) {
    LiveSummary live;
    live.captured = 90;
    live.dropped = 30;
    live.seconds = 3;
    EXPECT_FALSE(live_json(live).contains("recordings"));
    EXPECT_EQ(live_json(live)["lost"], 0);
    EXPECT_THAT(live_table(live), Not(HasSubstr("lost on the way")));
    live.lost = 123;
    EXPECT_EQ(live_json(live)["lost"], 123);
    EXPECT_THAT(live_table(live), AllOf(HasSubstr("lost on the way"), HasSubstr("123")));
    EXPECT_THAT(live_table(live), Not(HasSubstr("Recorded to")));
    live.recordings = {{"a<b.patina", 90, 2, 1000, 500}, {"c.patina", 9, 0, 100, 50}};
    EXPECT_EQ(live_json(live)["recordings"][0]["dropped"], 2);
    EXPECT_EQ(live_json(live)["recordings"][1]["file"], "c.patina");
    EXPECT_THAT(live_table(live), HasSubstr("a&lt;b.patina"));
    EXPECT_THAT(live_table(live), HasSubstr("30.0"));  // frames a second
}

}  // namespace
}  // namespace patina::live_summary_test
