#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "tests/simulated_kinect2/simulated_device.h"

namespace patina::sensor::kinect2::testing {

/// What the environment asks of a simulated bus. Every variable's name begins with PATINA_KINECT2_.
struct BusOptions {
    std::string device = "camera";        ///< DEVICE: camera, adaptor (without a camera), none
    bool high_speed = false;              ///< SPEED=high
    bool denied = false;                  ///< ACCESS=denied: the device may not be opened
    bool busy = false;                    ///< ACCESS=busy: another program has claimed its interfaces
    bool moves = false;                   ///< RESET=moves: the first reset puts the device on the bus anew
    bool cancel_hangs = false;            ///< CANCEL=hangs: cancelled transfers do not come back
    double frames_per_second = 30;        ///< RATE
    uint64_t usbfs_bytes = 16u << 20;     ///< USBFS_MB
    uint64_t unplug_after_intervals = 0;  ///< UNPLUG_AFTER, given in frames; 0: never
    /// UNPLUG_FILE: unplugged once it exists; of the stand-in alone, which then writes how many infrared frames it had
    /// sent to a file beside it, "NAME.sent".
    std::filesystem::path unplug_file;
    uint64_t transient_failures = 0;      ///< SUBMIT_FAILS: so many submissions fail, after the first 200
    uint32_t lose_every = 0;              ///< LOSE_EVERY: every n-th frame lacks a packet; 0: none
    std::filesystem::path infrared_file;  ///< INFRARED: frames of 2984960 bytes; the last one stays
    std::filesystem::path color_folder;   ///< COLOR: JPEG files by name; the last one stays
    bool swings = false;                  ///< SWING=1: both run forth and back instead, without end
    bool no_bandwidth = false;            ///< BANDWIDTH=none: alternate setting 1 is refused

    static BusOptions from_environment();
    /// The simulated device that they describe.
    SimulatedDeviceOptions device_options() const;
};

}  // namespace patina::sensor::kinect2::testing
