#include "sensor/kinect2/usb_library.h"

#include <algorithm>
#include <array>
#include <utility>

#include "engine/core/error.h"
#include "engine/core/printable.h"
#include "sensor/kinect2/transport.h"

namespace patina::sensor::kinect2::usb {
namespace {

std::string path_of(libusb_device* device) {
    std::array<uint8_t, 7> ports{};  // the most that USB 3 has in a row
    const int depth = libusb_get_port_numbers(device, ports.data(), static_cast<int>(ports.size()));
    std::string path = std::to_string(libusb_get_bus_number(device));
    for (int i = 0; i < depth; ++i) path += (i == 0 ? "-" : ".") + std::to_string(ports[static_cast<size_t>(i)]);
    return path;
}

bool of_interest(const libusb_device_descriptor& descriptor) {
    return descriptor.idVendor == kVendor &&
           (descriptor.idProduct == kAdaptorHub || std::ranges::count(kProducts, descriptor.idProduct) > 0);
}

}  // namespace

Context open_context() {
    libusb_context* context = nullptr;
    const int code = libusb_init(&context);
    if (code < 0) throw Error("the system's USB cannot be reached: ", libusb_strerror(code));
    return Context(context);
}

std::vector<Listed> list(libusb_context* context) {
    libusb_device** devices = nullptr;
    const ssize_t count = libusb_get_device_list(context, &devices);
    if (count < 0) throw Error("the USB devices cannot be listed: ", libusb_strerror(static_cast<int>(count)));
    std::vector<Listed> found;
    for (ssize_t i = 0; i < count; ++i) {
        DeviceRef device(devices[i]);  // takes over the list's reference
        libusb_device_descriptor descriptor{};
        if (libusb_get_device_descriptor(device.get(), &descriptor) < 0 || !of_interest(descriptor)) continue;
        std::string path = path_of(device.get());
        const int speed = libusb_get_device_speed(device.get());
        found.push_back({std::move(device), descriptor.idProduct, std::move(path), speed});
    }
    libusb_free_device_list(devices, 0);
    std::ranges::sort(found, {}, &Listed::path);
    return found;
}

bool is_camera(const Listed& device) { return device.product != kAdaptorHub; }

std::string name_of(const Listed& device) { return "Kinect v2 at " + device.path; }

void check(int code, const std::string& name, const char* what) {
    if (code >= 0) return;
    if (code == LIBUSB_ERROR_NO_DEVICE) throw Unplugged(name, " was unplugged");
    if (code == LIBUSB_ERROR_PIPE) throw Stalled(name, " refused ", what);
    if (code == LIBUSB_ERROR_ACCESS) {
        throw Error(name, " may not be opened: permission denied; patina doctor prints the udev rule that allows it");
    }
    if (code == LIBUSB_ERROR_BUSY) throw Error(name, " is used by another program (", what, ")");
    throw Error(name, ": ", what, " failed: ", libusb_strerror(code));
}

std::string serial_of(libusb_device_handle* handle) {
    libusb_device_descriptor descriptor{};
    std::array<unsigned char, 256> serial{};
    if (libusb_get_device_descriptor(libusb_get_device(handle), &descriptor) < 0) return {};
    if (descriptor.iSerialNumber == 0) return {};
    const int length = libusb_get_string_descriptor_ascii(handle, descriptor.iSerialNumber, serial.data(),
                                                          static_cast<int>(serial.size()));
    if (length <= 0) return {};
    return printable(std::string(serial.begin(), serial.begin() + length));
}

}  // namespace patina::sensor::kinect2::usb
