#include "sensor/kinect2/tick_clock.h"

#include <gtest/gtest.h>

namespace patina::sensor::kinect2::testing::tick_clock_test {
namespace {

TEST(Kinect2TickClock, EightThousandTicksAreASecondAcrossTheWrap) {
    TickClock clock;
    const uint32_t start = 0xFFFFFFFF - 4000;
    EXPECT_EQ(clock.seconds(start), 0);
    EXPECT_DOUBLE_EQ(clock.seconds(start + 8000), 1);
    EXPECT_DOUBLE_EQ(clock.seconds(start + 12000), 1.5);
}

TEST(Kinect2TickClock, DoesNotRunBackwards) {
    TickClock clock;
    clock.seconds(80000);
    EXPECT_DOUBLE_EQ(clock.seconds(88000), 1);
    EXPECT_DOUBLE_EQ(clock.seconds(0), 1) << "the device's clock started anew";
    EXPECT_DOUBLE_EQ(clock.seconds(800), 1.1);
}

TEST(Kinect2TickClock, CountsDaysExactly) {
    TickClock clock;
    double seconds = clock.seconds(0);
    const uint32_t day = 86400u * 8000u;
    for (uint32_t n = 1; n <= 30; ++n) seconds = clock.seconds(n * day);  // wraps five times
    EXPECT_DOUBLE_EQ(seconds, 30 * 86400.0);
}

}  // namespace
}  // namespace patina::sensor::kinect2::testing::tick_clock_test
