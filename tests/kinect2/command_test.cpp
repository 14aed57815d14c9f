#include <algorithm>
#include <functional>
#include <ostream>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include "sensor/kinect2/device.h"
#include "tests/kinect2/rig.h"

namespace patina::sensor::kinect2::testing::command_test {
namespace {

using ::testing::HasSubstr;

struct CommandCase {
    const char* name;
    std::function<void(CommandFaults&)> fault;
    const char* reason;
};

void PrintTo(const CommandCase& value, std::ostream* out) { *out << value.name; }

class Kinect2DeviceCommand : public ::testing::TestWithParam<CommandCase> {};
class Kinect2DevicePassingFault : public ::testing::TestWithParam<CommandCase> {};

TEST_P(Kinect2DeviceCommand, FaultThatStaysIsAnErrorWithItsReason) {
    SimulatedDeviceOptions options = small_and_quick();
    GetParam().fault(options.commands);
    Rig rig(options);
    EXPECT_THAT(failure_of([&] { rig.device->start(); }), HasSubstr(GetParam().reason));
    rig.simulated->command_faults() = {};
    rig.device->start();
    EXPECT_TRUE(rig.next()) << "and the device works once the fault is gone";
}

TEST_P(Kinect2DevicePassingFault, IsRepairedByAReset) {
    SimulatedDeviceOptions options = small_and_quick();
    GetParam().fault(options.commands);
    options.commands.times = 1;
    Rig rig(options);
    rig.device->start();
    EXPECT_TRUE(rig.next());
}

/// Faults of single commands: a reset repairs what caused them.
std::vector<CommandCase> passing_faults() {
    return {
        {"Early", [](auto& f) { f.early_completion = 0x22; }, "command 0x22 ended before its reply"},
        {"Short", [](auto& f) { f.short_payload = 0x22; }, "the reply to command 0x22 has 3 bytes"},
        {"ShortStatus", [](auto& f) { f.short_payload = 0x16; }, "the reply to command 0x16 has 3 bytes, must have 4"},
        {"Sequence", [](auto& f) { f.wrong_sequence = 0x09; }, "command 0x9 has number "},
        {"Status", [](auto& f) { f.failing = 0x2B; }, "command 0x2b failed with status 0x1"},
        {"Silent", [](auto& f) { f.silent = 0x14; }, "timeout"}};
}

std::vector<CommandCase> all_faults() {
    std::vector<CommandCase> faults = passing_faults();
    faults.push_back({"NotReady", [](auto& f) { f.not_ready_polls = 1000; }, "not ready after 50 polls (status 1024)"});
    faults.push_back({"Bandwidth", [](auto& f) { f.no_bandwidth = true; }, "no bandwidth"});
    return faults;
}

std::string name_of_case(const ::testing::TestParamInfo<CommandCase>& instance) { return instance.param.name; }

INSTANTIATE_TEST_SUITE_P(All, Kinect2DeviceCommand, ::testing::ValuesIn(all_faults()), name_of_case);
INSTANTIATE_TEST_SUITE_P(All, Kinect2DevicePassingFault, ::testing::ValuesIn(passing_faults()), name_of_case);

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
}  // namespace patina::sensor::kinect2::testing::command_test
