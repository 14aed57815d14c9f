#include "sensor/kinect2/usb_transport.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <optional>
#include <thread>
#include <utility>

#include "sensor/kinect2/usb_library.h"
#include "sensor/kinect2/usb_streams.h"

namespace patina::sensor::kinect2 {
namespace {

using namespace std::chrono_literals;

constexpr unsigned kTimeoutMs = 1000;
constexpr int kConfiguration = 1;
constexpr std::array<uint8_t, 2> kInterfaces{0, 1};
constexpr int kOpenAttempts = 10;
constexpr auto kBetweenAttempts = 100ms;
/// A device that comes back on the bus after a reset.
constexpr auto kEnumerationTime = 1000ms;

/// Opens a device that may be busy with coming up. Throws Error.
usb::Handle open_handle(const usb::Listed& listed) {
    int code = 0;
    for (int attempt = 0; attempt < kOpenAttempts; ++attempt) {
        if (attempt > 0) std::this_thread::sleep_for(kBetweenAttempts);
        libusb_device_handle* handle = nullptr;
        code = libusb_open(listed.device.get(), &handle);
        if (code == 0) return usb::Handle(handle);
        if (code == LIBUSB_ERROR_ACCESS || code == LIBUSB_ERROR_NO_DEVICE) break;
    }
    usb::check(code, usb::name_of(listed), "opening");
    throw Error(usb::name_of(listed), " cannot be opened");
}

void expect_super_speed(const usb::Listed& listed) {
    if (listed.speed >= LIBUSB_SPEED_SUPER || listed.speed == LIBUSB_SPEED_UNKNOWN) return;
    throw Error(usb::name_of(listed),
                " came up slower than USB 3 (SuperSpeed); check that port, cable and power supply are those of USB 3");
}

/// Throws Error, with the reason for which there is no camera.
[[noreturn]] void fail_absent(const std::vector<usb::Listed>& found, const std::string& serial) {
    const bool camera = std::ranges::any_of(found, usb::is_camera);
    if (camera) throw Error("no Kinect v2 with the serial number ", serial, " is connected");
    if (found.empty()) throw Error("no Kinect v2 is connected");
    throw Error("the Kinect's adaptor is connected, the Kinect is not; check its power supply and cable");
}

struct Opened {
    usb::Listed listed;
    usb::Handle handle;
    std::string serial;
};

Opened open_first(libusb_context* context, const std::string& serial) {
    std::vector<usb::Listed> found = usb::list(context);
    for (usb::Listed& listed : found) {
        if (!usb::is_camera(listed)) continue;
        usb::Handle handle = open_handle(listed);
        std::string its_serial = usb::serial_of(handle.get());
        if (serial.empty() || its_serial == serial)
            return {std::move(listed), std::move(handle), std::move(its_serial)};
    }
    fail_absent(found, serial);
}

class UsbTransport final : public Transport {
  public:
    explicit UsbTransport(const std::string& serial) : context_(usb::open_context()) {
        Opened opened = open_first(context_.get(), serial);
        path_ = opened.listed.path;
        name_ = usb::name_of(opened.listed);
        serial_ = opened.serial;
        handle_ = std::move(opened.handle);
        expect_super_speed(opened.listed);
        reset();
    }

    ~UsbTransport() override {
        stop_streams();
        if (!handle_) return;
        for (const uint8_t interface : {kInterfaces[1], kInterfaces[0]}) {
            libusb_release_interface(handle_.get(), interface);
        }
    }

    const std::string& name() const override { return name_; }
    const std::string& serial() const override { return serial_; }
    std::string warning() const override { return warning_; }

    void control(const ControlRequest& request) override {
        const int code = libusb_control_transfer(handle(), request.type, request.request, request.value, request.index,
                                                 nullptr, 0, kTimeoutMs);
        usb::check(code, name_, "a control request");
    }

    void send(std::span<const uint8_t> bytes) override {
        // libusb takes one kind of pointer for both directions; it does not write here.
        const int sent = transfer(usb::kCommandEndpoint, const_cast<uint8_t*>(bytes.data()), bytes.size(), "a command");
        if (static_cast<size_t>(sent) != bytes.size()) {
            throw Error(name_, ": ", sent, " of a command's ", bytes.size(), " bytes were sent");
        }
    }

    size_t receive(std::span<uint8_t> bytes) override {
        return static_cast<size_t>(transfer(usb::kReplyEndpoint, bytes.data(), bytes.size(), "the reply to a command"));
    }

    void set_alternate_setting(uint8_t interface, uint8_t setting) override {
        // When the device is gone, libusb 1.0.26 unlocks a mutex here that it did not lock (its issue 1199), and aborts
        // the program when the handle is closed. To claim what is claimed tells whether it is gone, and does nothing
        // else.
        usb::check(libusb_claim_interface(handle(), interface), name_, "claiming its interfaces");
        const int code = libusb_set_interface_alt_setting(handle(), interface, setting);
        if (code == LIBUSB_ERROR_NO_DEVICE) {  // gone in between: its mutex may be broken
            handle_.release();
            gone_ = true;
            throw Unplugged(name_, " was unplugged");
        }
        if (code < 0 && setting != 0) {
            throw Error(name_, ": the host controller does not reserve the bandwidth of the infrared stream (",
                        libusb_strerror(code), "); those of Intel and Renesas do, those of ASMedia mostly not");
        }
        usb::check(code, name_, "setting an interface");
    }

    uint32_t infrared_bytes_per_interval() override {
        libusb_config_descriptor* configuration = nullptr;
        usb::check(libusb_get_active_config_descriptor(libusb_get_device(handle()), &configuration), name_,
                   "reading the configuration");
        const std::unique_ptr<libusb_config_descriptor, usb::Release<libusb_free_config_descriptor>> owner(
            configuration);
        return bytes_per_interval(*configuration).value_or(0);
    }

    /// A reset may put the device on the bus anew, under another address; it is then opened again.
    void reset() override {
        stop_streams();
        const int code = handle_ ? libusb_reset_device(handle_.get()) : LIBUSB_ERROR_NOT_FOUND;
        if (code == LIBUSB_ERROR_NOT_FOUND) {
            reopen();
        } else {
            usb::check(code, name_, "the reset");
        }
        configure();
    }

    void start_streams(TransferSink& sink) override {
        stop_streams();
        warning_.clear();
        streams_ = std::make_unique<usb::Streams>(context_.get(), handle(), sink, name_);
        try {
            streams_->start();
        } catch (...) {
            stop_streams();
            throw;
        }
        warning_ = streams_->warning();
    }

    void stop_streams() noexcept override {
        if (!streams_) return;
        // The kernel lets go of buffers that it does not give back when the handle is closed.
        if (!streams_->stop()) handle_.reset();
        streams_.reset();
    }

  private:
    libusb_device_handle* handle() const {
        if (gone_) throw Unplugged(name_, " was unplugged");
        if (!handle_) throw Error(name_, " was closed, because it did not give back its transfers");
        return handle_.get();
    }

    int transfer(uint8_t endpoint, uint8_t* bytes, size_t size, const char* what) {
        int transferred = 0;
        usb::check(libusb_bulk_transfer(handle(), endpoint, bytes, static_cast<int>(size), &transferred, kTimeoutMs),
                   name_, what);
        return transferred;
    }

    void reopen() {
        handle_.reset();
        std::this_thread::sleep_for(kEnumerationTime);
        for (const usb::Listed& listed : usb::list(context_.get())) {
            if (listed.path == path_ && usb::is_camera(listed)) handle_ = open_handle(listed);
        }
        if (!handle_) throw Unplugged(name_, " did not come back after its reset");
        gone_ = false;
    }

    void configure() {
        int active = 0;
        usb::check(libusb_get_configuration(handle(), &active), name_, "reading the configuration");
        libusb_set_auto_detach_kernel_driver(handle(), 1);  // where a driver of the kernel has claimed the camera
        if (active != kConfiguration) {
            usb::check(libusb_set_configuration(handle(), kConfiguration), name_, "setting the configuration");
        }
        for (const uint8_t interface : kInterfaces) {
            usb::check(libusb_claim_interface(handle(), interface), name_, "claiming its interfaces");
        }
    }

    std::optional<uint32_t> bytes_per_interval(const libusb_config_descriptor& configuration) const {
        for (uint8_t i = 0; i < configuration.bNumInterfaces; ++i) {
            const libusb_interface& interface = configuration.interface[i];
            for (int a = 0; a < interface.num_altsetting; ++a) {
                const libusb_interface_descriptor& setting = interface.altsetting[a];
                for (uint8_t e = 0; e < setting.bNumEndpoints; ++e) {
                    if (setting.endpoint[e].bEndpointAddress == usb::kInfraredEndpoint)
                        return companion(setting.endpoint[e]);
                }
            }
        }
        return std::nullopt;
    }

    std::optional<uint32_t> companion(const libusb_endpoint_descriptor& endpoint) const {
        libusb_ss_endpoint_companion_descriptor* descriptor = nullptr;
        if (libusb_get_ss_endpoint_companion_descriptor(context_.get(), &endpoint, &descriptor) < 0)
            return std::nullopt;
        const uint32_t bytes = descriptor->wBytesPerInterval;
        libusb_free_ss_endpoint_companion_descriptor(descriptor);
        return bytes;
    }

    // In this order: streams before the handle, the handle before the context.
    usb::Context context_;
    usb::Handle handle_;
    std::unique_ptr<usb::Streams> streams_;
    bool gone_ = false;  ///< and its handle given up
    std::string path_, name_, serial_, warning_;
};

}  // namespace

std::unique_ptr<Transport> open_usb(const std::string& serial) { return std::make_unique<UsbTransport>(serial); }

}  // namespace patina::sensor::kinect2
