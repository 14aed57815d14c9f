#include "sensor/kinect2/diagnosis.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string_view>
#include <utility>

#include "engine/core/error.h"
#include "engine/core/printable.h"
#include "sensor/kinect2/usb_library.h"

namespace patina::sensor::kinect2 {
namespace {

namespace fs = std::filesystem;

/// 60 x 8 packets and 20 colour transfers, 16.55 MB, need the 16 MiB that Linux grants by default.
constexpr uint32_t kNeededMib = 16;

/// The first word of a file of the system; empty where there is none.
std::string word_of(const fs::path& file) {
    std::ifstream in(file);
    std::string word;
    in >> word;
    return printable(word);
}

std::string speed_name(int speed) {
    switch (speed) {
        case LIBUSB_SPEED_LOW: return "low speed (USB 1)";
        case LIBUSB_SPEED_FULL: return "full speed (USB 1)";
        case LIBUSB_SPEED_HIGH: return "high speed (USB 2)";
        case LIBUSB_SPEED_SUPER: return "SuperSpeed";
        case LIBUSB_SPEED_SUPER_PLUS: return "SuperSpeed+";
        default: return "unknown speed";
    }
}

struct Maker {
    std::string_view id;
    const char* name;
    bool doubtful;
};

constexpr Maker kMakers[] = {{"0x8086", "Intel", false}, {"0x1912", "Renesas", false}, {"0x1033", "NEC", false},
                             {"0x1022", "AMD", false},   {"0x1b21", "ASMedia", true},  {"0x1106", "VIA", true}};

std::string without_0x(const std::string& id) { return id.starts_with("0x") ? id.substr(2) : id; }

ConnectedDevice look_at(const usb::Listed& listed, const SystemPaths& system) {
    ConnectedDevice device;
    device.name = usb::name_of(listed);
    device.speed = speed_name(listed.speed);
    device.fast_enough = listed.speed >= LIBUSB_SPEED_SUPER;
    device.controller = find_controller(system.devices, libusb_get_bus_number(listed.device.get()));
    libusb_device_handle* opened = nullptr;
    const int code = libusb_open(listed.device.get(), &opened);
    const usb::Handle handle(opened);
    device.denied = code == LIBUSB_ERROR_ACCESS;
    if (code < 0) {
        device.access_error = libusb_strerror(code);
    } else {
        device.serial = usb::serial_of(handle.get());
    }
    return device;
}

std::optional<uint32_t> usbfs_memory(const fs::path& file) {
    std::ifstream in(file);
    uint32_t mib = 0;
    if (!(in >> mib)) return std::nullopt;
    return mib;
}

class Report {
  public:
    template <class... Parts>
    void line(const char* label, const Parts&... parts) {
        out_ << "  " << label << std::string(18 - std::string_view(label).size(), ' ') << text(parts...) << "\n";
    }

    void add(const ConnectedDevice& device) {
        out_ << device.name << "\n";
        line("speed", device.speed,
             device.fast_enough ? "" : ": too slow; check that port, cable and power supply are those of USB 3");
        if (!device.controller.name.empty()) {
            line(
                "controller", device.controller.name,
                device.controller.doubtful ? "; controllers of this make mostly do not carry the infrared stream" : "");
        }
        if (device.access_error.empty()) {
            line("access", "yes");
            line("serial number", device.serial.empty() ? "not given" : device.serial);
            return;
        }
        line("access", "no: ", device.access_error);
        if (!device.denied) return;
        line("remedy", "as root, write this line to ", usb::kUdevFile, ", then plug the Kinect in anew:");
        out_ << "    " << usb::kUdevRule << "\n";
    }

    void add_memory(uint32_t mib) {
        if (mib == 0) return line("USB memory", "not limited");
        line("USB memory", mib, " MiB (usbcore.usbfs_memory_mb)",
             mib < kNeededMib ? text(": too little, ", kNeededMib, " are needed; boot with usbcore.usbfs_memory_mb=64")
                              : (mib < 2 * kNeededMib ? ": enough for one Kinect" : ""));
    }

    std::string str() const { return out_.str(); }

  private:
    std::ostringstream out_;
};

}  // namespace

Controller find_controller(const fs::path& devices, uint8_t bus) {
    std::error_code error;
    // The root hub's parent.
    const fs::path folder = fs::canonical(devices / text("usb", int{bus}), error).parent_path();
    const std::string vendor = word_of(folder / "vendor"), product = word_of(folder / "device");
    if (error || vendor.empty()) return {};
    const auto* const maker = std::ranges::find(kMakers, vendor, &Maker::id);
    const bool known = maker != std::end(kMakers);
    Controller controller;
    controller.doubtful = known && maker->doubtful;
    controller.name =
        text(known ? maker->name : "unknown make", " (", without_0x(vendor), ":", without_0x(product), ")");
    const fs::path driver = fs::read_symlink(folder / "driver", error).filename();
    if (!driver.empty()) controller.name += ", driver " + printable(driver.string());
    return controller;
}

Diagnosis diagnose(const SystemPaths& system) {
    Diagnosis diagnosis;
    diagnosis.usbfs_memory_mib = usbfs_memory(system.usbfs_memory);
    try {
        const usb::Context context = usb::open_context();
        bool adaptor = false;
        for (const usb::Listed& listed : usb::list(context.get())) {
            adaptor |= !usb::is_camera(listed);
            if (usb::is_camera(listed)) diagnosis.devices.push_back(look_at(listed, system));
        }
        diagnosis.adaptor_alone = adaptor && diagnosis.devices.empty();
    } catch (const Error& error) {
        diagnosis.usb_error = error.what();
    }
    return diagnosis;
}

std::string format(const Diagnosis& diagnosis) {
    Report report;
    for (const ConnectedDevice& device : diagnosis.devices) report.add(device);
    std::string none = "none is connected";
    if (diagnosis.adaptor_alone) none = "the adaptor is connected, the camera is not: check its power supply and cable";
    if (!diagnosis.usb_error.empty()) none = diagnosis.usb_error;
    std::string lines = report.str();
    if (diagnosis.devices.empty()) lines = text("Kinect v2: ", none, "\n");
    Report system;
    if (diagnosis.usbfs_memory_mib) system.add_memory(*diagnosis.usbfs_memory_mib);
    return lines + system.str();
}

}  // namespace patina::sensor::kinect2
