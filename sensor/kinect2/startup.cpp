#include "sensor/kinect2/startup.h"

#include <string>
#include <thread>

#include "sensor/kinect2/little_endian.h"

namespace patina::sensor::kinect2 {
namespace {

// bmRequestType: a standard request from the host to the device, or to one of its interfaces.
constexpr uint8_t kToDevice = 0x00, kToInterface = 0x01;
constexpr uint8_t kSetFeature = 0x03, kSetIsochronousDelay = 0x31;
constexpr uint16_t kIsochronousDelayNs = 40;
constexpr uint16_t kFunctionSuspend = 0, kU1Enable = 48, kU2Enable = 49;
/// Options of kFunctionSuspend in the high byte, the interface in the low one: low power and remote wake; none.
constexpr uint16_t kSuspend = 0x0300, kResume = 0x0000;
constexpr uint8_t kInfraredInterface = 1, kStreamOff = 0, kStreamOn = 1;

constexpr uint32_t kStatusAddress = 0x00090000, kReady = 1;
constexpr uint32_t kSerialPage = 1, kP0Page = 2, kDepthPage = 3, kColorPage = 4;

void set_feature(Transport& transport, uint8_t recipient, uint16_t feature, uint16_t index) {
    transport.control({recipient, kSetFeature, feature, index});
}

// Levels of the lights, which other drivers send in this order; what they mean is unknown.
void blink(Commands& commands, uint32_t level) {
    commands.execute(Opcode::kMode, {1, level, 0, 0});
    commands.execute(Opcode::kMode, {0, 0, 0, 0});
}

constexpr uint32_t kHalfLevels = 0x00640064;

uint32_t status(Commands& commands) {
    return read_at<uint32_t>(commands.execute(Opcode::kStatus, {kStatusAddress}, {4, 4}), 0);
}

std::vector<uint8_t> page(Commands& commands, uint32_t number, ReplyBytes bytes) {
    return commands.execute(Opcode::kPage, {number}, bytes);
}

CalibrationPages read_pages(Commands& commands) {
    CalibrationPages pages;
    pages.firmware = commands.execute(Opcode::kFirmware, {}, {64, 0x200});
    commands.execute(Opcode::kHardware, {}, {0, 0x5C});
    pages.serial = page(commands, kSerialPage, {2, 0x80});
    pages.depth_parameters = page(commands, kDepthPage, {40, 0x1C0000});
    pages.p0_tables = page(commands, kP0Page, {1302572, 0x1C0000});
    pages.color_parameters = page(commands, kColorPage, {101, 0x1C0000});
    return pages;
}

void wait_until_ready(Transport& transport, Commands& commands, const Readiness& readiness) {
    uint32_t last = 0;
    for (int poll = 0; poll < readiness.polls; ++poll) {
        if (poll > 0) std::this_thread::sleep_for(readiness.interval);
        last = status(commands);
        if (last & kReady) return;
    }
    throw Error(transport.name(), ": the sensor is not ready after ", readiness.polls, " polls (status ", last,
                "); unplug its power supply for some seconds");
}

void start_infrared(Transport& transport, Commands& commands) {
    commands.execute(Opcode::kStartInfrared);
    transport.set_alternate_setting(kInfraredInterface, kStreamOn);
}

}  // namespace

void prepare(Transport& transport) {
    transport.control({kToDevice, kSetIsochronousDelay, kIsochronousDelayNs, 0});
    transport.set_alternate_setting(kInfraredInterface, kStreamOff);
    try {
        set_feature(transport, kToDevice, kU1Enable, 0);
        set_feature(transport, kToDevice, kU2Enable, 0);
    } catch (const Stalled&) {
        throw Error(transport.name(),
                    ": the link is not SuperSpeed; check that port, cable and power supply are those of USB 3");
    }
    set_feature(transport, kToInterface, kFunctionSuspend, kSuspend);
    const uint32_t reserved = transport.infrared_bytes_per_interval();
    if (reserved < kInfraredPacketBytes) {
        throw Error(transport.name(), ": the infrared endpoint has ", reserved, " bytes an interval, must have ",
                    kInfraredPacketBytes);
    }
}

CalibrationPages start_sensors(Transport& transport, Commands& commands, const Readiness& readiness) {
    set_feature(transport, kToInterface, kFunctionSuspend, kResume);
    CalibrationPages pages = read_pages(commands);
    blink(commands, kHalfLevels);
    wait_until_ready(transport, commands, readiness);
    start_infrared(transport, commands);
    status(commands);
    commands.execute(Opcode::kColorStream, {1});
    return pages;
}

void stop_sensors(Transport& transport, Commands& commands) {
    transport.set_alternate_setting(kInfraredInterface, kStreamOff);
    blink(commands, kHalfLevels);
    commands.execute(Opcode::kStopInfrared);
    commands.execute(Opcode::kColorStream, {0});
    blink(commands, 0);
    blink(commands, 0);
    set_feature(transport, kToInterface, kFunctionSuspend, kSuspend);
}

void say_goodbye(Commands& commands) { blink(commands, kHalfLevels); }

}  // namespace patina::sensor::kinect2
