#include <algorithm>
#include <functional>
#include <ostream>

#include <gmock/gmock.h>

#include "sensor/kinect2/device.h"
#include "tests/kinect2/rig.h"

namespace patina::sensor::kinect2::testing {
namespace {

using ::testing::HasSubstr;

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

}  // namespace
}  // namespace patina::sensor::kinect2::testing
