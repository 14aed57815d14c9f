#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "sensor/kinect2/transport.h"
#include "tests/simulated_kinect2/simulated_device.h"

namespace patina::sensor::kinect2::testing {

/// A simulated device behind the driver's transport. Time passes when a test says so, or on a thread of its own.
class SimulatedTransport final : public Transport {
  public:
    enum class Clock {
        kByHand,  ///< intervals pass in pass() alone, on the thread that calls it
        kOwn,     ///< as fast as they can, on an event thread
    };

    explicit SimulatedTransport(std::shared_ptr<SimulatedDevice> device, Clock clock = Clock::kByHand);
    ~SimulatedTransport() override { stop_streams(); }

    /// Lets intervals of 125 us pass.
    void pass(uint64_t intervals);
    /// As pass(), for an event thread that slept: all transfers are handed over together, when the intervals are over.
    void pass_asleep(uint64_t intervals);
    /// How many transfers the sink of the present run has had.
    uint64_t exchanges() const { return exchanges_; }

    const std::string& name() const override { return name_; }
    const std::string& serial() const override { return serial_; }
    void control(const ControlRequest& request) override;
    void send(std::span<const uint8_t> bytes) override;
    size_t receive(std::span<uint8_t> bytes) override;
    void set_alternate_setting(uint8_t interface, uint8_t setting) override;
    uint32_t infrared_bytes_per_interval() override { return device_->bytes_per_interval(); }
    void reset() override;
    void start_streams(TransferSink& sink) override;
    void stop_streams() noexcept override;

  private:
    void expect(Answer answer) const;
    void pass_interval();
    void fill_infrared(const SentPacket& packet);
    void fill_color(std::span<const uint8_t> bytes);
    void hand_over(Transfer& transfer);

    std::shared_ptr<SimulatedDevice> device_;
    Clock clock_;
    std::string name_ = "simulated Kinect v2", serial_;
    TransferSink* sink_ = nullptr;
    Transfer infrared_{StreamKind::kInfrared}, color_{StreamKind::kColor};
    size_t filled_ = 0;  ///< packets of infrared_
    bool asleep_ = false;
    std::vector<Transfer> kept_;  ///< while asleep
    bool ended_ = false;
    std::atomic<uint64_t> exchanges_ = 0;
    std::jthread thread_;
};

}  // namespace patina::sensor::kinect2::testing
