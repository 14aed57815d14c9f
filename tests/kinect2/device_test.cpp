#include "sensor/kinect2/device.h"

#include <bit>
#include <random>
#include <thread>

#include <gmock/gmock.h>

#include "tests/kinect2/rig.h"
#include "tests/simulated_kinect2/flat_jpeg.h"
#include "tests/simulated_kinect2/pages.h"

namespace patina::sensor::kinect2::testing {
namespace {

using ::testing::AllOf;
using ::testing::AnyOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

template <class Work>
std::string failure_of(Work work) {
    try {
        work();
    } catch (const Error& error) {
        return error.what();
    }
    return "none";
}

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
    Rig rig;  // frames differ, so that a mixture would show
    rig.device->start();
    std::vector<uint32_t> sequences;
    RawFrame frame;
    for (int round = 0; round < 6; ++round) {
        rig.transport->pass(1800);  // 225 transfers of infrared at once, while 64 may wait
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
}

// Commands

struct CommandCase {
    const char* name;
    std::function<void(CommandFaults&)> fault;
    const char* reason;
};

void PrintTo(const CommandCase& value, std::ostream* out) { *out << value.name; }

class Kinect2DeviceCommand : public ::testing::TestWithParam<CommandCase> {};

TEST_P(Kinect2DeviceCommand, FaultThatStaysIsAnErrorWithItsReason) {
    SimulatedDeviceOptions options = small_and_quick();
    GetParam().fault(options.commands);
    Rig rig(options);
    EXPECT_THAT(failure_of([&] { rig.device->start(); }), HasSubstr(GetParam().reason));
    rig.simulated->command_faults() = {};
    rig.device->start();
    EXPECT_TRUE(rig.next()) << "and the device works once the fault is gone";
}

TEST_P(Kinect2DeviceCommand, FaultThatPassesIsRepairedByAReset) {
    SimulatedDeviceOptions options = small_and_quick();
    GetParam().fault(options.commands);
    options.commands.times = 1;
    Rig rig(options);
    if (options.commands.no_bandwidth || options.commands.not_ready_polls > 0) return;  // these do not pass
    rig.device->start();
    EXPECT_TRUE(rig.next());
}

INSTANTIATE_TEST_SUITE_P(
    All, Kinect2DeviceCommand,
    ::testing::Values(
        CommandCase{"Early", [](auto& f) { f.early_completion = 0x22; }, "command 0x22 ended before its reply"},
        CommandCase{"Short", [](auto& f) { f.short_payload = 0x22; }, "the reply to command 0x22 has 3 bytes"},
        CommandCase{"ShortStatus", [](auto& f) { f.short_payload = 0x16; },
                    "the reply to command 0x16 has 3 bytes, must have 4"},
        CommandCase{"Sequence", [](auto& f) { f.wrong_sequence = 0x09; }, "command 0x9 has number "},
        CommandCase{"Status", [](auto& f) { f.failing = 0x2B; }, "command 0x2b failed with status 0x1"},
        CommandCase{"Silent", [](auto& f) { f.silent = 0x14; }, "timeout"},
        CommandCase{"NotReady", [](auto& f) { f.not_ready_polls = 1000; }, "not ready after 50 polls (status 1024)"},
        CommandCase{"Bandwidth", [](auto& f) { f.no_bandwidth = true; }, "no bandwidth"}),
    [](const auto& instance) { return instance.param.name; });

TEST(Kinect2Device, SensorThatGetsReadyLateIsWaitedFor) {
    SimulatedDeviceOptions options = small_and_quick();
    options.commands.not_ready_polls = 49;
    Rig rig(options);
    rig.device->start();
    EXPECT_TRUE(rig.next());
}

TEST(Kinect2Device, SlowLinkIsRefusedAtOnce) {
    SimulatedDeviceOptions options = small_and_quick();
    options.commands.high_speed = true;
    EXPECT_THAT(failure_of([&] { Rig rig(options); }), HasSubstr("the link is not SuperSpeed"));
    options.commands.high_speed = false;
    options.commands.bytes_per_interval = 33791;
    EXPECT_THAT(failure_of([&] { Rig rig(options); }), HasSubstr("has 33791 bytes an interval, must have 33792"));
}

TEST(Kinect2Device, DamagedCalibrationIsRefused) {
    SimulatedDeviceOptions options = small_and_quick();
    std::fill_n(options.pages.depth_parameters.begin(), 4, uint8_t{0});
    Rig rig(options);
    EXPECT_THAT(failure_of([&] { rig.device->start(); }), HasSubstr("has fx 0"));
}

// Settings

float setting(const Rig& rig, uint32_t id) {
    return std::bit_cast<float>(rig.simulated->color_setting(id).value_or(0));
}

TEST(Kinect2Device, ExposureIsSetWhileRunningAndKeptByTheNextStart) {
    Rig rig(small_and_quick());
    rig.device->set_exposure(ManualExposure{5, 2});  // before the first start
    EXPECT_FALSE(rig.simulated->color_setting(0));
    rig.device->start();
    EXPECT_EQ(rig.simulated->color_setting(25), 0u);
    EXPECT_EQ(rig.simulated->color_setting(0), 4u);
    EXPECT_EQ(setting(rig, 1), 5);
    EXPECT_EQ(setting(rig, 21), 2);
    rig.device->set_exposure(SemiAutomaticExposure{100});
    EXPECT_EQ(rig.simulated->color_setting(0), 3u);
    EXPECT_EQ(setting(rig, 17), 100);
    rig.device->set_exposure(AutomaticExposure{-1.5f});
    EXPECT_EQ(rig.simulated->color_setting(0), 0u);
    EXPECT_EQ(setting(rig, 23), -1.5f);
    EXPECT_TRUE(rig.next()) << "the stream goes on";
}

TEST(Kinect2Device, WhiteBalanceCanBeFixedAsItIs) {
    Rig rig(small_and_quick());
    rig.device->start();
    const WhiteBalanceGains gains = rig.device->white_balance();
    EXPECT_EQ(gains.red, 1.5f);
    rig.device->set_white_balance(WhiteBalanceGains{gains.red, 2, 3});
    EXPECT_EQ(rig.simulated->color_setting(10), 3u);
    EXPECT_EQ(setting(rig, 11), 1.5f);
    EXPECT_EQ(setting(rig, 12), 2);
    EXPECT_EQ(setting(rig, 13), 3);
    EXPECT_EQ(rig.device->white_balance().blue, 3);
    rig.device->set_white_balance(std::nullopt);
    EXPECT_EQ(rig.simulated->color_setting(10), 1u);
}

TEST(Kinect2Device, SettingsOutOfRangeAreRefusedBeforeTheDeviceSeesThem) {
    Rig rig(small_and_quick());
    for (const ExposureControl& wrong :
         {ExposureControl(AutomaticExposure{3}), ExposureControl(SemiAutomaticExposure{641}),
          ExposureControl(ManualExposure{67, 1}), ExposureControl(ManualExposure{-1, 1}),
          ExposureControl(ManualExposure{5, 0.5f}), ExposureControl(ManualExposure{NAN, 1})}) {
        EXPECT_THAT(failure_of([&] { rig.device->set_exposure(wrong); }), HasSubstr("must be within"));
    }
    EXPECT_THAT(failure_of([&] {
                    rig.device->set_white_balance(WhiteBalanceGains{1, 0, 1});
                }),
                HasSubstr("is 0, must be positive"));
    rig.device->start();
    EXPECT_FALSE(rig.simulated->color_setting(0));
}

// Unplugging

/// A run from start to stop over a device that goes after so many calls. Returns how it ended, "none" when it did not.
std::string run_until_unplugged(uint64_t calls) {
    SimulatedDeviceOptions options = small_and_quick();
    options.commands.not_ready_polls = 1;
    const auto simulated = std::make_shared<SimulatedDevice>(options);
    simulated->unplug_after(calls);
    auto over = std::make_unique<SimulatedTransport>(simulated);
    SimulatedTransport& transport = *over;
    return failure_of([&] {
        Device device(std::move(over), Rig::quick());
        device.start();
        transport.pass(2 * kIntervalsPerFrame + 520);
        RawFrame frame;
        device.next(frame);
        device.stop();
        if (simulated->gone()) throw Unplugged("simulated Kinect v2 was unplugged");
    });
}

TEST(Kinect2DeviceUnplugged, AtEveryStepOfStartStreamAndStop) {
    uint64_t whole_run = 0;
    {
        const auto simulated = std::make_shared<SimulatedDevice>(small_and_quick());
        Device device(std::make_unique<SimulatedTransport>(simulated), Rig::quick());
        device.start();
        whole_run = simulated->calls();
    }
    ASSERT_GT(whole_run, 30u);
    for (uint64_t calls = 0; calls < whole_run + 5; ++calls) {
        EXPECT_EQ(run_until_unplugged(calls), "simulated Kinect v2 was unplugged") << calls;
    }
    const uint64_t streaming = 2 * kIntervalsPerFrame + 520;
    for (uint64_t calls = whole_run; calls < whole_run + streaming; calls += 37) {
        EXPECT_THAT(run_until_unplugged(calls), AnyOf("simulated Kinect v2 was unplugged", "none")) << calls;
    }
    for (uint64_t calls = whole_run + streaming; calls < whole_run + streaming + 40; ++calls) {
        EXPECT_THAT(run_until_unplugged(calls), AnyOf("simulated Kinect v2 was unplugged", "none")) << calls;
    }
    EXPECT_EQ(run_until_unplugged(1u << 30), "none");
}

/// Runs a device whose event thread runs freely until it is unplugged; returns how that ended.
std::string run_freely(const std::shared_ptr<SimulatedDevice>& simulated, int& frames) {
    DeviceOptions driver = Rig::quick();
    driver.waiting_transfers = 16;  // quick to allocate; overruns do not matter here
    driver.silence = 1min;          // frames may all be lost to overruns
    return failure_of([&] {
        Device device(std::make_unique<SimulatedTransport>(simulated, SimulatedTransport::Clock::kOwn), driver);
        device.start();
        RawFrame frame;
        while (device.next(frame)) ++frames;
    });
}

TEST(Kinect2DeviceUnplugged, FiveHundredTimesAfterARandomNumberOfIntervals) {
    std::mt19937 random(20);
    int frames = 0;
    for (int run = 0; run < 500; ++run) {
        const auto simulated = std::make_shared<SimulatedDevice>(small_and_quick());
        simulated->unplug_after(std::uniform_int_distribution(0u, 1200u)(random));
        ASSERT_EQ(run_freely(simulated, frames), "simulated Kinect v2 was unplugged") << run;
    }
    EXPECT_GT(frames, 0) << "some runs got as far as frames";
}

TEST(Kinect2DeviceUnplugged, FiveHundredTimesAtARandomMomentByAnotherThread) {
    std::mt19937 random(21);
    int frames = 0;
    for (int run = 0; run < 500; ++run) {
        const auto simulated = std::make_shared<SimulatedDevice>(small_and_quick());
        const auto wait = std::chrono::microseconds(std::uniform_int_distribution(0, 8000)(random));
        std::thread hand([&] {
            std::this_thread::sleep_for(wait);
            simulated->unplug();
        });
        const std::string failure = run_freely(simulated, frames);
        hand.join();
        ASSERT_EQ(failure, "simulated Kinect v2 was unplugged") << run;
    }
}

TEST(Kinect2DeviceUnplugged, FramesBeforeItAreStillReturned) {
    Rig rig(small_and_quick());
    rig.device->start();
    for (int i = 0; i < 4; ++i) rig.pass_frame_time();
    rig.simulated->unplug();
    rig.transport->pass(1);
    RawFrame frame;
    EXPECT_TRUE(rig.device->next(frame));
    EXPECT_THROW(while (rig.device->next(frame)){}, Unplugged);
    EXPECT_NO_THROW(rig.device->stop());
    EXPECT_THROW(rig.device->start(), Unplugged);
}

}  // namespace
}  // namespace patina::sensor::kinect2::testing
