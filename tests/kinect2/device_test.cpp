#include "sensor/kinect2/device.h"

#include <algorithm>
#include <thread>

#include <gmock/gmock.h>

#include "tests/kinect2/rig.h"
#include "tests/simulated_kinect2/flat_jpeg.h"
#include "tests/simulated_kinect2/pages.h"

namespace patina::sensor::kinect2::testing::device_test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST(Kinect2Device, FramesComeOutAsTheyWereSent) {
    Rig rig;
    rig.device->start();
    for (uint32_t n = 0; n < 4; ++n) {
        const std::optional<RawFrame> frame = rig.next();
        ASSERT_TRUE(frame) << n;
        EXPECT_EQ(frame->sequence, n);
        EXPECT_EQ(frame->color_sequence, n);
        EXPECT_EQ(frame->timestamp, begin_of(10ull * n));
        EXPECT_EQ(frame->color_timestamp, frame->timestamp);
        EXPECT_EQ(frame->infrared, *patterned_frame(n));
        EXPECT_EQ(frame->color, flat_jpeg(1920, 1080, static_cast<uint8_t>(n)));
        EXPECT_EQ(frame->color_exposure_ms, 10);
    }
    const StreamStatistics statistics = rig.device->statistics();
    EXPECT_EQ(statistics.frames, 4u);
    EXPECT_EQ(statistics.infrared.lost_frames + statistics.color.lost_frames + statistics.overruns, 0u);
    EXPECT_EQ(statistics.infrared.dropped_sub_images + statistics.unpaired_infrared + statistics.unpaired_color, 0u);
}

TEST(Kinect2Device, CalibrationIsThatOfTheDevice) {
    Rig rig(small_and_quick());
    rig.device->start();
    const Calibration expected = simulated_calibration();
    const Calibration& read = rig.device->calibration();
    EXPECT_EQ(read.serial, expected.serial);
    EXPECT_EQ(read.depth.fx, expected.depth.fx);
    EXPECT_EQ(read.color.mx, expected.color.mx);
    EXPECT_EQ(read.p0, expected.p0);
    EXPECT_EQ(rig.device->pages().p0_tables, pages_of(expected).p0_tables);
}

TEST(Kinect2Device, CommandsComeInTheOrderThatDevicesKnow) {
    Rig rig(small_and_quick());
    rig.device->start();
    rig.device->stop();
    EXPECT_THAT(rig.simulated->opcodes(),
                ElementsAre(0x02, 0x14, 0x22, 0x22, 0x22, 0x22, 0x4B, 0x4B, 0x16, 0x09, 0x16, 0x2B,  // start
                            0x4B, 0x4B, 0x0A, 0x2B, 0x4B, 0x4B, 0x4B, 0x4B));                        // stop
    EXPECT_FALSE(rig.simulated->streaming_infrared());
    EXPECT_FALSE(rig.simulated->streaming_color());
}

TEST(Kinect2Device, OneLostPacketCostsOnePair) {
    SimulatedDeviceOptions options = small_and_quick();
    options.infrared.packet = [](const PacketPlace& at, SentPacket& packet) {
        if (at.frame == 2 && at.sub_image == 4 && at.packet == 4) packet.complete = false;
    };
    options.color.transfer = [](uint32_t frame, uint32_t) { return frame != 4; };
    Rig rig(options);
    rig.device->start();
    std::vector<uint32_t> sequences;
    while (sequences.size() < 5) {
        const std::optional<RawFrame> frame = rig.next();
        ASSERT_TRUE(frame);
        sequences.push_back(frame->sequence);
        EXPECT_EQ(frame->color_sequence, frame->sequence);
    }
    EXPECT_THAT(sequences, ElementsAre(0, 1, 3, 5, 6));
    const StreamStatistics statistics = rig.device->statistics();
    EXPECT_EQ(statistics.infrared.lost_frames, 1u);
    EXPECT_EQ(statistics.color.lost_frames, 1u);
    EXPECT_EQ(statistics.unpaired_color, 1u);
    EXPECT_EQ(statistics.unpaired_infrared, 1u);
}

TEST(Kinect2Device, CountersThatWrapLoseNothing) {
    SimulatedDeviceOptions options = small_and_quick();
    options.first_infrared_sequence = options.first_color_sequence = 0xFFFFFFFE;
    options.first_timestamp = static_cast<uint32_t>(-400);
    Rig rig(options);
    rig.device->start();
    std::vector<uint32_t> sequences;
    for (int n = 0; n < 4; ++n) {
        const std::optional<RawFrame> frame = rig.next();
        ASSERT_TRUE(frame);
        sequences.push_back(frame->sequence);
    }
    EXPECT_THAT(sequences, ElementsAre(0xFFFFFFFE, 0xFFFFFFFF, 0, 1));
    EXPECT_EQ(rig.device->statistics().infrared.lost_frames, 0u);
}

TEST(Kinect2Device, FramesThatNobodyFetchesGiveWayToNewerOnes) {
    Rig rig(small_and_quick());
    rig.device->start();
    for (int i = 0; i < 12; ++i) rig.pass_frame_time();
    const StreamStatistics statistics = rig.device->statistics();
    EXPECT_EQ(statistics.dropped_frames, statistics.frames - 3);
    RawFrame frame;
    ASSERT_TRUE(rig.device->next(frame));
    EXPECT_EQ(frame.sequence, statistics.frames - 3);
}

TEST(Kinect2Device, StartsAndStopsAHundredTimes) {
    Rig rig(small_and_quick());
    for (int run = 0; run < 100; ++run) {
        rig.device->start();
        const std::optional<RawFrame> frame = rig.next();
        ASSERT_TRUE(frame) << run;
        EXPECT_EQ(frame->sequence, 0u) << "nothing of the run before is left";
        if (run % 2 == 0) rig.device->stop();  // or starts while it runs
    }
}

TEST(Kinect2Device, StopTwiceAndNextWithoutStartAreClear) {
    Rig rig(small_and_quick());
    rig.device->stop();
    RawFrame frame;
    EXPECT_EQ(failure_of([&] { rig.device->next(frame); }), "simulated Kinect v2 is not started");
    rig.device->start();
    rig.device->stop();
    rig.device->stop();
    EXPECT_EQ(failure_of([&] { rig.device->next(frame); }), "simulated Kinect v2 is not started");
}

TEST(Kinect2Device, InterruptEndsNextUntilTheNextStart) {
    Rig rig(small_and_quick());
    rig.device->start();
    rig.device->interrupt();
    RawFrame frame;
    EXPECT_FALSE(rig.device->next(frame));
    rig.device->start();
    EXPECT_TRUE(rig.next());
}

TEST(Kinect2Device, SilenceIsAnErrorThatSaysWhatIsMissing) {
    SimulatedDeviceOptions options = small_and_quick();
    options.infrared.packet = [](const PacketPlace& at, SentPacket& packet) { packet.complete = at.packet != 3; };
    Rig rig(options);
    rig.device->start();
    for (int i = 0; i < 5; ++i) rig.pass_frame_time();
    RawFrame frame;
    EXPECT_THAT(failure_of([&] { rig.device->next(frame); }),
                AllOf(HasSubstr("no frame for 200 ms: no infrared frame arrived whole"), HasSubstr("packets lost")));
}

TEST(Kinect2Device, OverrunIsCountedAndMixesNoFrames) {
    DeviceOptions driver = Rig::quick();
    driver.waiting_transfers = 36;  // a frame and a little more
    Rig rig({}, driver);            // frames differ, so that a mixture would show
    rig.device->start();
    std::vector<uint32_t> sequences;
    RawFrame frame;
    // Until some were lost and some came through: how many, the machine's other work decides.
    const auto shown = [&] { return rig.device->statistics().overruns > 0 && !sequences.empty(); };
    for (int round = 0; round < 6 || (round < 100 && !shown()); ++round) {
        rig.transport->pass_asleep(1800);  // 225 transfers of infrared at once, while 36 may wait
        while (rig.device->statistics().transfers + rig.device->statistics().overruns < rig.transport->exchanges()) {
            std::this_thread::sleep_for(100us);
        }
        for (uint64_t n = rig.device->statistics().frames - sequences.size() - rig.device->statistics().dropped_frames;
             n > 0; --n) {
            ASSERT_TRUE(rig.device->next(frame));
            sequences.push_back(frame.sequence);
            EXPECT_EQ(frame.infrared, *patterned_frame(frame.sequence)) << frame.sequence;
            EXPECT_EQ(frame.color, flat_jpeg(1920, 1080, static_cast<uint8_t>(frame.color_sequence)));
        }
    }
    EXPECT_TRUE(std::is_sorted(sequences.begin(), sequences.end()));
    EXPECT_GT(rig.device->statistics().overruns, 0u);
    EXPECT_FALSE(sequences.empty());
}

}  // namespace
}  // namespace patina::sensor::kinect2::testing::device_test
