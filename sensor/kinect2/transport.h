#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "engine/core/error.h"
#include "sensor/kinect2/transfer.h"

namespace patina::sensor::kinect2 {

/// The device is gone. Nothing but opening it again, once it is back, can help.
class Unplugged : public Error {
  public:
    using Error::Error;
};

/// The device refused a control request (a stalled endpoint).
class Stalled : public Error {
  public:
    using Error::Error;
};

/// A control request without data.
struct ControlRequest {
    uint8_t type = 0;
    uint8_t request = 0;
    uint16_t value = 0;
    uint16_t index = 0;
};

/// Takes what the streams bring. Both functions are called on the transport's event thread and return at once.
class TransferSink {
  public:
    virtual ~TransferSink() = default;
    /// Exchanges a filled transfer for an empty one of the same kind. Where none is left, what it holds is lost.
    virtual void exchange(Transfer& transfer) noexcept = 0;
    /// No more transfers come, for the reason given. Not called when stop_streams() ends them.
    virtual void end(bool unplugged, const std::string& reason) noexcept = 0;
};

/// How the driver reaches a device: over libusb (usb_transport.h), or a simulated one. The device is open, its
/// interfaces are claimed. Every function throws Unplugged when the device is gone, and Error when the transfer fails
/// or takes longer than a second.
class Transport {
  public:
    virtual ~Transport() = default;

    /// The device, for messages: "Kinect v2 at 2-1".
    virtual const std::string& name() const = 0;
    /// The serial number in the device's USB descriptor.
    virtual const std::string& serial() const = 0;

    /// Throws Stalled when the device refuses.
    virtual void control(const ControlRequest& request) = 0;
    /// Sends a command to endpoint 0x02.
    virtual void send(std::span<const uint8_t> bytes) = 0;
    /// Reads one bulk transfer of endpoint 0x81; returns its length, at most that of `bytes`.
    virtual size_t receive(std::span<uint8_t> bytes) = 0;
    virtual void set_alternate_setting(uint8_t interface, uint8_t setting) = 0;
    /// wBytesPerInterval of endpoint 0x84: what the bus reserves for the infrared stream.
    virtual uint32_t infrared_bytes_per_interval() = 0;
    /// Brings the device back to where it was when it was opened.
    virtual void reset() = 0;

    /// Submits all transfers of both streams; from here on `sink` gets them. The sink must outlive stop_streams().
    virtual void start_streams(TransferSink& sink) = 0;
    /// Cancels all transfers and returns once no call to the sink runs or follows. Does nothing when nothing streams.
    virtual void stop_streams() noexcept = 0;
    /// What worked less well than it should, such as fewer transfers than asked for. Empty: nothing.
    virtual std::string warning() const { return {}; }
};

}  // namespace patina::sensor::kinect2
