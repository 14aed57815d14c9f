#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <libusb.h>

namespace patina::sensor::kinect2::usb {

inline constexpr uint16_t kVendor = 0x045E;
/// Kinect for Windows v2; Xbox One sensor and preview units; the hub in the adaptor of both.
inline constexpr uint16_t kProducts[] = {0x02D8, 0x02C4};
inline constexpr uint16_t kAdaptorHub = 0x02D9;

/// Endpoints: commands, their replies, and the two streams.
inline constexpr uint8_t kCommandEndpoint = 0x02, kReplyEndpoint = 0x81, kColorEndpoint = 0x83,
                         kInfraredEndpoint = 0x84;

/// Lets every local user of a seat open the device.
inline constexpr const char* kUdevRule =
    R"(SUBSYSTEM=="usb", ATTR{idVendor}=="045e", ATTR{idProduct}=="02c4|02d8|02d9", MODE="0660", TAG+="uaccess")";
inline constexpr const char* kUdevFile = "/etc/udev/rules.d/60-kinect2.rules";

template <auto release>
struct Release {
    template <class T>
    void operator()(T* object) const {
        release(object);
    }
};

using Context = std::unique_ptr<libusb_context, Release<libusb_exit>>;
using DeviceRef = std::unique_ptr<libusb_device, Release<libusb_unref_device>>;
using Handle = std::unique_ptr<libusb_device_handle, Release<libusb_close>>;

/// A context of its own. Throws Error when libusb cannot reach the system's USB.
Context open_context();

/// A device as the bus shows it, not opened.
struct Listed {
    DeviceRef device;
    uint16_t product = 0;
    std::string path;  ///< as the kernel names it: "2-1.3" is bus 2, port 1 and then 3
    int speed = LIBUSB_SPEED_UNKNOWN;
};

/// All Kinects v2 and their adaptors' hubs, by path. Throws Error.
std::vector<Listed> list(libusb_context* context);

bool is_camera(const Listed& device);

/// "Kinect v2 at 2-1.3"
std::string name_of(const Listed& device);

/// Throws what a libusb error code means when it is one: Unplugged, Stalled, or Error with the remedy where there is
/// one. `what` is what was tried: "SET_FEATURE".
void check(int code, const std::string& name, const char* what);

/// The serial number; empty where the device does not say.
std::string serial_of(libusb_device_handle* handle);

}  // namespace patina::sensor::kinect2::usb
