#include <cstdlib>
#include <random>
#include <thread>

#include <gmock/gmock.h>

#include "sensor/kinect2/device.h"
#include "tests/kinect2/rig.h"

namespace patina::sensor::kinect2::testing::unplug_test {
namespace {

using ::testing::AnyOf;

/// Each of the tests below that unplug at random; PATINA_UNPLUGS=500 makes them a thousand in all.
int unplugs() {
    const char* asked = std::getenv("PATINA_UNPLUGS");
    return asked ? std::atoi(asked) : 60;
}

/// On a busy machine, the assembling thread may take longer than the rig's patience.
DeviceOptions patient() {
    DeviceOptions options = Rig::quick();
    options.silence = 1min;
    return options;
}

/// A run from start to stop over a device that goes after so many calls. Returns how it ended, "none" when it did not.
std::string run_until_unplugged(uint64_t calls) {
    SimulatedDeviceOptions options = small_and_quick();
    options.commands.not_ready_polls = 1;
    const auto simulated = std::make_shared<SimulatedDevice>(options);
    simulated->unplug_after(calls);
    auto over = std::make_unique<SimulatedTransport>(simulated);
    SimulatedTransport& transport = *over;
    return failure_of([&] {
        Device device(std::move(over), patient());
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
    DeviceOptions driver = patient();
    driver.waiting_transfers = 72;  // more than a frame's transfers: some frames come through
    return failure_of([&] {
        Device device(std::make_unique<SimulatedTransport>(simulated, SimulatedTransport::Clock::kOwn), driver);
        device.start();
        RawFrame frame;
        while (device.next(frame)) ++frames;
    });
}

TEST(Kinect2DeviceUnplugged, ManyTimesAfterARandomNumberOfIntervals) {
    std::mt19937 random(20);
    int frames = 0;
    for (int run = 0; run < unplugs(); ++run) {
        const auto simulated = std::make_shared<SimulatedDevice>(small_and_quick());
        simulated->unplug_after(std::uniform_int_distribution(0u, 1200u)(random));
        ASSERT_EQ(run_freely(simulated, frames), "simulated Kinect v2 was unplugged") << run;
    }
    EXPECT_GT(frames, 0) << "some runs got as far as frames";
}

TEST(Kinect2DeviceUnplugged, ManyTimesAtARandomMomentByAnotherThread) {
    std::mt19937 random(21);
    int frames = 0;
    for (int run = 0; run < unplugs(); ++run) {
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
}  // namespace patina::sensor::kinect2::testing::unplug_test
