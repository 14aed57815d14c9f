#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <cstring>
#include <memory>

#include <libusb.h>

#include "tests/simulated_kinect2/stand_in/bus.h"

// What the driver uses of libusb's API, around a simulated device. A program that loads this library in place of
// libusb's runs as if the device were there. Each context has a bus of its own, so that there is no global state.

using patina::sensor::kinect2::testing::Answer;
using patina::sensor::kinect2::testing::Bus;
using patina::sensor::kinect2::testing::BusOptions;

struct libusb_device {
    libusb_context* context;
    uint16_t product;
    std::atomic<int> references = 1;
};

struct libusb_context {
    BusOptions options = BusOptions::from_environment();
    Bus bus{options};
    bool moved = false;  ///< by a reset
};

struct libusb_device_handle {
    libusb_device* device;
    bool stale = false;   ///< the device was put on the bus anew
    bool broken = false;  ///< its mutex was unlocked without having been locked
};

namespace {

constexpr uint16_t kCamera = 0x02C4, kAdaptorHub = 0x02D9;

// The endpoints of the device. Strings, audio and the association are not looked at.
const libusb_endpoint_descriptor kEndpoints[] = {
    {7, LIBUSB_DT_ENDPOINT, 0x02, LIBUSB_TRANSFER_TYPE_BULK, 1024, 0, 0, 0, nullptr, 0},
    {7, LIBUSB_DT_ENDPOINT, 0x81, LIBUSB_TRANSFER_TYPE_BULK, 1024, 0, 0, 0, nullptr, 0},
    {7, LIBUSB_DT_ENDPOINT, 0x82, LIBUSB_TRANSFER_TYPE_INTERRUPT, 64, 8, 0, 0, nullptr, 0},
    {7, LIBUSB_DT_ENDPOINT, 0x83, LIBUSB_TRANSFER_TYPE_BULK, 1024, 0, 0, 0, nullptr, 0},
    {7, LIBUSB_DT_ENDPOINT, 0x84, LIBUSB_TRANSFER_TYPE_ISOCHRONOUS, 1024, 1, 0, 0, nullptr, 0},
};
const libusb_interface_descriptor kSettings[] = {
    {9, LIBUSB_DT_INTERFACE, 0, 0, 4, LIBUSB_CLASS_VENDOR_SPEC, 0, 0, 0, kEndpoints, nullptr, 0},
    {9, LIBUSB_DT_INTERFACE, 1, 0, 0, LIBUSB_CLASS_VENDOR_SPEC, 0, 0, 0, nullptr, nullptr, 0},
    {9, LIBUSB_DT_INTERFACE, 1, 1, 1, LIBUSB_CLASS_VENDOR_SPEC, 0, 0, 0, kEndpoints + 4, nullptr, 0},
};
const libusb_interface kInterfaces[] = {{kSettings, 1}, {kSettings + 1, 2}};

int code_of(Answer answer) {
    switch (answer) {
        case Answer::kDone: return 0;
        case Answer::kStalled: return LIBUSB_ERROR_PIPE;
        case Answer::kTimedOut: return LIBUSB_ERROR_TIMEOUT;
        case Answer::kGone: return LIBUSB_ERROR_NO_DEVICE;
        case Answer::kNoBandwidth: return LIBUSB_ERROR_OTHER;
    }
    return LIBUSB_ERROR_OTHER;
}

Bus& bus_of(libusb_device_handle* handle) { return handle->device->context->bus; }

}  // namespace

extern "C" {

int libusb_init(libusb_context** context) {
    *context = new libusb_context;
    return 0;
}

void libusb_exit(libusb_context* context) { delete context; }

const char* libusb_strerror(int code) {
    switch (code) {
        case LIBUSB_ERROR_ACCESS: return "Access denied (insufficient permissions)";
        case LIBUSB_ERROR_BUSY: return "Resource busy";
        case LIBUSB_ERROR_NO_MEM: return "Insufficient memory";
        case LIBUSB_ERROR_TIMEOUT: return "Operation timed out";
        case LIBUSB_ERROR_NO_DEVICE: return "No such device (it may have been disconnected)";
        default: return "Other error";
    }
}

ssize_t libusb_get_device_list(libusb_context* context, libusb_device*** list) {
    const BusOptions& options = context->options;
    const size_t count = options.device == "none" || context->bus.device().gone() ? 0 : 1;
    *list = static_cast<libusb_device**>(std::calloc(count + 1, sizeof(libusb_device*)));
    if (count > 0) (*list)[0] = new libusb_device{context, options.device == "adaptor" ? kAdaptorHub : kCamera};
    return static_cast<ssize_t>(count);
}

void libusb_unref_device(libusb_device* device) {
    if (--device->references == 0) delete device;
}

libusb_device* libusb_ref_device(libusb_device* device) {
    ++device->references;
    return device;
}

void libusb_free_device_list(libusb_device** list, int unreference) {
    for (libusb_device** device = list; unreference != 0 && *device != nullptr; ++device) libusb_unref_device(*device);
    std::free(list);
}

int libusb_get_device_descriptor(libusb_device* device, libusb_device_descriptor* descriptor) {
    *descriptor = {};
    descriptor->idVendor = 0x045E;
    descriptor->idProduct = device->product;
    descriptor->iSerialNumber = 3;
    return 0;
}

uint8_t libusb_get_bus_number(libusb_device*) { return 2; }

int libusb_get_port_numbers(libusb_device*, uint8_t* ports, int) {
    ports[0] = 1;
    ports[1] = 3;
    return 2;
}

int libusb_get_device_speed(libusb_device* device) {
    return device->context->options.high_speed ? LIBUSB_SPEED_HIGH : LIBUSB_SPEED_SUPER;
}

int libusb_open(libusb_device* device, libusb_device_handle** handle) {
    if (device->context->options.denied) return LIBUSB_ERROR_ACCESS;
    if (device->context->bus.device().gone()) return LIBUSB_ERROR_NO_DEVICE;
    *handle = new libusb_device_handle{libusb_ref_device(device)};
    return 0;
}

void libusb_close(libusb_device_handle* handle) {
    if (handle->broken) std::abort();
    bus_of(handle).forget_transfers();
    libusb_unref_device(handle->device);
    delete handle;
}

libusb_device* libusb_get_device(libusb_device_handle* handle) { return handle->device; }

int libusb_get_string_descriptor_ascii(libusb_device_handle*, uint8_t, unsigned char* data, int length) {
    const char serial[] = "012345678901";
    const int size = std::min<int>(length, sizeof serial - 1);
    std::memcpy(data, serial, static_cast<size_t>(size));
    return size;
}

int libusb_get_configuration(libusb_device_handle* handle, int* configuration) {
    *configuration = 0;
    return bus_of(handle).device().gone() ? LIBUSB_ERROR_NO_DEVICE : 0;
}

int libusb_set_configuration(libusb_device_handle*, int configuration) {
    return configuration == 1 ? 0 : LIBUSB_ERROR_NOT_FOUND;
}

int libusb_set_auto_detach_kernel_driver(libusb_device_handle*, int) { return LIBUSB_ERROR_NOT_SUPPORTED; }

int libusb_claim_interface(libusb_device_handle* handle, int) {
    if (handle->stale || bus_of(handle).device().gone()) return LIBUSB_ERROR_NO_DEVICE;
    return handle->device->context->options.busy ? LIBUSB_ERROR_BUSY : 0;
}

int libusb_release_interface(libusb_device_handle*, int) { return 0; }

int libusb_reset_device(libusb_device_handle* handle) {
    libusb_context& context = *handle->device->context;
    if (context.options.moves && !context.moved) {
        context.moved = handle->stale = true;
        return LIBUSB_ERROR_NOT_FOUND;
    }
    return code_of(bus_of(handle).device().reset());
}

int libusb_set_interface_alt_setting(libusb_device_handle* handle, int interface, int setting) {
    if (handle->stale || bus_of(handle).device().gone()) {
        handle->broken = true;  // as libusb 1.0.26 does (its issue 1199)
        return LIBUSB_ERROR_NO_DEVICE;
    }
    return code_of(
        bus_of(handle).device().set_alternate_setting(static_cast<uint8_t>(interface), static_cast<uint8_t>(setting)));
}

int libusb_get_active_config_descriptor(libusb_device*, libusb_config_descriptor** descriptor) {
    *descriptor = new libusb_config_descriptor{};
    (*descriptor)->bNumInterfaces = 2;
    (*descriptor)->bConfigurationValue = 1;
    (*descriptor)->interface = kInterfaces;
    return 0;
}

void libusb_free_config_descriptor(libusb_config_descriptor* descriptor) { delete descriptor; }

int libusb_get_ss_endpoint_companion_descriptor(libusb_context* context, const libusb_endpoint_descriptor* endpoint,
                                                libusb_ss_endpoint_companion_descriptor** descriptor) {
    if (endpoint->bEndpointAddress != 0x84) return LIBUSB_ERROR_NOT_FOUND;
    *descriptor = new libusb_ss_endpoint_companion_descriptor{};
    (*descriptor)->wBytesPerInterval = static_cast<uint16_t>(context->bus.device().bytes_per_interval());
    return 0;
}

void libusb_free_ss_endpoint_companion_descriptor(libusb_ss_endpoint_companion_descriptor* descriptor) {
    delete descriptor;
}

int libusb_control_transfer(libusb_device_handle* handle, uint8_t type, uint8_t request, uint16_t value, uint16_t index,
                            unsigned char*, uint16_t, unsigned) {
    if (handle->stale) return LIBUSB_ERROR_NO_DEVICE;
    return code_of(bus_of(handle).device().control(type, request, value, index));
}

int libusb_bulk_transfer(libusb_device_handle* handle, unsigned char endpoint, unsigned char* data, int length,
                         int* transferred, unsigned) {
    const auto size = static_cast<size_t>(length);
    if (endpoint == 0x02) {
        *transferred = length;
        return code_of(bus_of(handle).device().send({data, size}));
    }
    size_t received = 0;
    const Answer answer = bus_of(handle).device().receive({data, size}, received);
    *transferred = static_cast<int>(received);
    return code_of(answer);
}

libusb_transfer* libusb_alloc_transfer(int packets) {
    return static_cast<libusb_transfer*>(
        std::calloc(1, sizeof(libusb_transfer) + static_cast<size_t>(packets) * sizeof(libusb_iso_packet_descriptor)));
}

void libusb_free_transfer(libusb_transfer* transfer) { std::free(transfer); }

int libusb_submit_transfer(libusb_transfer* transfer) { return bus_of(transfer->dev_handle).submit(transfer); }

int libusb_cancel_transfer(libusb_transfer* transfer) { return bus_of(transfer->dev_handle).cancel(transfer); }

int libusb_handle_events_timeout_completed(libusb_context* context, timeval* patience, int*) {
    context->bus.handle_events(*patience);
    return 0;
}

void libusb_interrupt_event_handler(libusb_context* context) { context->bus.interrupt(); }

}  // extern "C"
