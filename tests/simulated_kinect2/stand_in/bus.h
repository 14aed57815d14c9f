#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <mutex>
#include <vector>

#include <libusb.h>

#include "tests/simulated_kinect2/bus_clock.h"
#include "tests/simulated_kinect2/bus_options.h"

namespace patina::sensor::kinect2::testing {

/// The host controller and the kernel: fills submitted transfers with what the simulated device sends, in real time, on
/// a thread named "kinect2-bus". An isochronous packet for which no transfer was submitted is lost, as on a real bus.
class Bus {
  public:
    explicit Bus(const BusOptions& options);

    /// All as the libusb functions of the same name, with libusb's codes.
    int submit(libusb_transfer* transfer);
    int cancel(libusb_transfer* transfer);
    void handle_events(const timeval& patience);
    void interrupt();
    /// Takes all transfers back without a callback.
    void forget_transfers();

    SimulatedDevice& device() { return device_; }

  private:
    struct Completion {
        libusb_transfer* transfer;
        libusb_transfer_status status;
    };

    void pass_interval();
    void receive(const SentPacket& packet);
    bool receive(std::span<const uint8_t> bytes);
    void complete(std::deque<libusb_transfer*>& queue, libusb_transfer_status status);
    void complete_all(libusb_transfer_status status);
    std::deque<libusb_transfer*>& queue_of(const libusb_transfer* transfer);

    BusOptions options_;
    SimulatedDevice device_;

    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<libusb_transfer*> isochronous_, bulk_;  ///< submitted, in order
    std::vector<Completion> completed_;
    int filled_ = 0;  ///< packets of the first isochronous transfer
    uint64_t bytes_in_use_ = 0, submissions_ = 0, intervals_ = 0;
    bool interrupted_ = false;
    bool hung_ = false;  ///< cancelled transfers do not come back

    BusClock clock_;
};

}  // namespace patina::sensor::kinect2::testing
