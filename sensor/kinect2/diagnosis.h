#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace patina::sensor::kinect2 {

/// Where Linux shows its devices and the settings of its modules.
struct SystemPaths {
    std::filesystem::path devices = "/sys/bus/usb/devices";
    std::filesystem::path usbfs_memory = "/sys/module/usbcore/parameters/usbfs_memory_mb";
};

/// The host controller of a bus.
struct Controller {
    std::string name;       ///< "Intel (8086:a36d), driver xhci_hcd"; empty where the system does not say
    bool doubtful = false;  ///< of a make that mostly does not carry the infrared stream
};

/// One Kinect v2 as the bus shows it.
struct ConnectedDevice {
    std::string name;   ///< "Kinect v2 at 2-1.3"
    std::string speed;  ///< "SuperSpeed"
    bool fast_enough = false;
    Controller controller;
    std::string serial;        ///< empty where it could not be opened
    std::string access_error;  ///< why it could not be opened; empty: it could
    bool denied = false;       ///< for lack of permission
};

/// What keeps a Kinect v2 from working, as far as the system shows it.
struct Diagnosis {
    std::string usb_error;  ///< why the system's USB cannot be reached; empty: it can
    std::vector<ConnectedDevice> devices;
    bool adaptor_alone = false;                ///< its hub is there, the camera is not
    std::optional<uint32_t> usbfs_memory_mib;  ///< 0: no limit; empty where the system does not say
};

/// The controller of bus `bus`, from the folder of USB devices in /sys.
Controller find_controller(const std::filesystem::path& devices, uint8_t bus);

/// Looks for devices; opens each for a moment, and changes nothing. Does not throw what concerns USB.
Diagnosis diagnose(const SystemPaths& system = {});

/// The same in words, with the remedy beside each obstacle; indented lines.
std::string format(const Diagnosis& diagnosis);

}  // namespace patina::sensor::kinect2
