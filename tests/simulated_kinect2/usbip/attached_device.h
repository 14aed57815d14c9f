#pragma once

#include <cstdint>
#include <deque>
#include <mutex>
#include <span>
#include <vector>

#include "tests/simulated_kinect2/bus_clock.h"
#include "tests/simulated_kinect2/bus_options.h"
#include "tests/simulated_kinect2/usbip/messages.h"
#include "tests/simulated_kinect2/usbip/socket.h"

namespace patina::sensor::kinect2::testing::usbip {

/// A simulated Kinect v2 at the far end of a USB/IP connection: answers what a host's kernel submits. An isochronous
/// packet for which no transfer was submitted is lost, as on a real bus.
class AttachedDevice {
  public:
    AttachedDevice(Socket host, const BusOptions& options);

    /// Serves the host until it detaches the device, or the device is unplugged.
    void serve();

    /// What the host did against the device's protocol; empty: nothing.
    std::string complaint() const { return device_.complaint(); }

  private:
    using Queue = std::deque<Command>;

    void take(Command command);
    void unlink(const Command& command);
    void control(const Command& command);
    void send(const Command& command);
    void answer_pending_receives();
    Queue* queue_of(const Command& command);
    void reply(const Command& command, const Reply& reply);

    void pass_interval();
    void receive(const SentPacket& packet);
    bool receive(std::span<const uint8_t> bytes);

    Socket host_;
    BusOptions options_;
    SimulatedDevice device_;

    std::mutex mutex_;  ///< also of what is written, so that a transfer never ends after its unlinking was answered
    Queue replies_, color_, infrared_, interrupt_;  ///< transfers that wait, in order
    Reply filled_;                                  ///< packets of the first isochronous transfer
    size_t filled_packets_ = 0;
    uint64_t intervals_ = 0;

    BusClock clock_;
};

}  // namespace patina::sensor::kinect2::testing::usbip
