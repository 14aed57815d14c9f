#pragma once

#include <memory>
#include <optional>
#include <string>

#include <gtest/gtest.h>

#include "sensor/kinect2/device.h"
#include "tests/simulated_kinect2/simulated_transport.h"

namespace patina::sensor::kinect2::testing {

using namespace std::chrono_literals;

/// Intervals of 125 us, rounded up.
constexpr uint64_t kIntervalsPerFrame = 267;

/// The driver's device over a simulated one, whose time passes by hand. At its end nothing may have breached the
/// device's protocol.
struct Rig {
    explicit Rig(SimulatedDeviceOptions options = {}, DeviceOptions driver = quick());
    ~Rig();

    /// No waiting for what is simulated.
    static DeviceOptions quick();

    /// Lets a frame's time pass, and waits until the assemblers are through with what it brought.
    void pass_frame_time();

    /// Lets time pass until the next pair is there; empty when none is after `most` frames' time.
    std::optional<RawFrame> next(int most = 6);

    std::shared_ptr<SimulatedDevice> simulated;
    SimulatedTransport* transport = nullptr;
    std::unique_ptr<Device> device;
};

/// The message of the Error that `work` throws; "none" when it throws none.
template <class Work>
std::string failure_of(Work work) {
    try {
        work();
    } catch (const Error& error) {
        return error.what();
    }
    return "none";
}

/// One infrared frame again and again, and pictures of six bytes: what tests use that look at neither.
SimulatedDeviceOptions small_and_quick();

}  // namespace patina::sensor::kinect2::testing
