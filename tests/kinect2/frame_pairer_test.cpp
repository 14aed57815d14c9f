#include "sensor/kinect2/frame_pairer.h"

#include <gmock/gmock.h>

namespace patina::sensor::kinect2::testing::frame_pairer_test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::Pair;

using Pairs = std::vector<std::pair<uint32_t, uint32_t>>;

InfraredFrame infrared(uint32_t timestamp) { return {timestamp, timestamp, {1, 2, 3}}; }
ColorFrame color(uint32_t timestamp) { return {timestamp, timestamp, 10, 1, 1, {4, 5}}; }

/// The pairs that are there, as their two time stamps.
Pairs pairs_of(FramePairer& pairer) {
    Pairs pairs;
    RawFrame frame;
    while (pairer.next(frame)) {
        EXPECT_EQ(frame.infrared, (std::vector<uint8_t>{1, 2, 3}));
        EXPECT_EQ(frame.color, (std::vector<uint8_t>{4, 5}));
        pairs.emplace_back(frame.timestamp, frame.color_timestamp);
    }
    return pairs;
}

TEST(Kinect2Pairing, ColorThatComesLaterFindsItsFrame) {
    FramePairer pairer;
    pairer.add(infrared(1000));
    pairer.add(infrared(1266));
    pairer.add(infrared(1533));
    EXPECT_THAT(pairs_of(pairer), IsEmpty());
    pairer.add(color(1002));
    pairer.add(color(1264));
    EXPECT_THAT(pairs_of(pairer), ElementsAre(Pair(1000, 1002), Pair(1266, 1264)));
    EXPECT_EQ(pairer.unpaired_infrared() + pairer.unpaired_color(), 0u);
}

TEST(Kinect2Pairing, SixteenMillisecondsAreTheMost) {
    for (const int apart : {-129, -128, 0, 128, 129}) {
        FramePairer pairer;
        pairer.add(infrared(1000));
        pairer.add(color(static_cast<uint32_t>(1000 + apart)));
        EXPECT_EQ(pairs_of(pairer).size(), std::abs(apart) <= 128 ? 1u : 0u) << apart;
    }
}

TEST(Kinect2Pairing, AtHalfTheRateEverySecondFrameHasColor) {
    FramePairer pairer;
    Pairs pairs;
    for (uint32_t n = 0; n < 6; ++n) {
        pairer.add(infrared(266 * n));
        if (n % 2 == 0) pairer.add(color(266 * n + 5));
        for (const auto& pair : pairs_of(pairer)) pairs.push_back(pair);
    }
    EXPECT_THAT(pairs, ElementsAre(Pair(0, 5), Pair(532, 537), Pair(1064, 1069)));
    EXPECT_EQ(pairer.unpaired_infrared(), 2u) << "the last may still find one";
}

TEST(Kinect2Pairing, LostFramesCostTheirPartnerAlone) {
    FramePairer pairer;
    for (const uint32_t n : {0u, 1u, 3u, 4u}) pairer.add(infrared(266 * n));
    for (const uint32_t n : {0u, 2u, 3u, 4u}) pairer.add(color(266 * n));
    EXPECT_THAT(pairs_of(pairer), ElementsAre(Pair(0, 0), Pair(798, 798), Pair(1064, 1064)));
    EXPECT_EQ(pairer.unpaired_infrared(), 1u);
    EXPECT_EQ(pairer.unpaired_color(), 1u);
}

TEST(Kinect2Pairing, TimeStampsWrap) {
    FramePairer pairer;
    pairer.add(infrared(0xFFFFFFF0));
    pairer.add(infrared(0xFFFFFFF0 + 266));
    pairer.add(color(0xFFFFFFF0 + 30));  // 14, just past the wrap
    pairer.add(color(0xFFFFFFF0 + 266));
    EXPECT_THAT(pairs_of(pairer), ElementsAre(Pair(0xFFFFFFF0, 14), Pair(250, 250)));
}

TEST(Kinect2Pairing, StreamWithoutPartnerHoldsAFewFramesOnly) {
    FramePairer pairer;
    for (uint32_t n = 0; n < 100; ++n) pairer.add(infrared(266 * n));
    EXPECT_EQ(pairer.unpaired_infrared(), 94u);
    FramePairer other;
    for (uint32_t n = 0; n < 100; ++n) other.add(color(266 * n));
    EXPECT_EQ(other.unpaired_color(), 94u);
}

TEST(Kinect2Pairing, ClockThatJumpsIsFollowed) {
    FramePairer pairer;
    pairer.add(color(5'000'000));  // colour's clock is ahead for one picture
    for (uint32_t n = 0; n < 3; ++n) pairer.add(infrared(266 * n));
    EXPECT_THAT(pairs_of(pairer), IsEmpty());
    for (uint32_t n = 10; n < 20; ++n) {
        pairer.add(infrared(266 * n));
        pairer.add(color(266 * n));
    }
    EXPECT_GT(pairs_of(pairer).size(), 4u);
}

TEST(Kinect2Pairing, BuffersCirculate) {
    FramePairer pairer;
    InfraredFrame frame = infrared(0);
    frame.bytes.resize(1000);
    const uint8_t* const bytes = frame.bytes.data();
    pairer.add(std::move(frame));
    pairer.add(color(0));
    RawFrame first, second;
    ASSERT_TRUE(pairer.next(first));
    EXPECT_EQ(first.infrared.data(), bytes);
    pairer.add(infrared(266));
    pairer.add(color(266));
    ASSERT_TRUE(pairer.next(first));
    EXPECT_EQ(pairer.spare_infrared().bytes.data(), bytes) << "the caller's buffer came back";
}

}  // namespace
}  // namespace patina::sensor::kinect2::testing::frame_pairer_test
