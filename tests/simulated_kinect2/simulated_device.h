#pragma once

#include <atomic>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "sensor/kinect2/calibration.h"
#include "tests/simulated_kinect2/color_signal.h"
#include "tests/simulated_kinect2/infrared_signal.h"

namespace patina::sensor::kinect2::testing {

/// How a transfer ended.
enum class Answer { kDone, kStalled, kTimedOut, kGone, kNoBandwidth };

/// What can go wrong with commands. Opcodes as in the device's protocol.
struct CommandFaults {
    std::optional<uint32_t> early_completion;  ///< opcode whose completion comes in place of the payload
    std::optional<uint32_t> short_payload;     ///< opcode whose payload is cut to 3 bytes
    std::optional<uint32_t> wrong_sequence;    ///< opcode whose completion has another number
    std::optional<uint32_t> failing;           ///< opcode whose completion has status 1
    std::optional<uint32_t> silent;            ///< opcode that is not answered at all
    int times = 1 << 30;                       ///< how often the faults above happen
    int not_ready_polls = 0;                   ///< status 0x400 so often
    bool high_speed = false;                   ///< U1_ENABLE stalls
    bool no_bandwidth = false;                 ///< alternate setting 1 is refused
    uint32_t bytes_per_interval = 33792;
};

struct SimulatedDeviceOptions {
    CalibrationPages pages;
    CommandFaults commands;
    InfraredFaults infrared;
    ColorFaults color;
    InfraredSignal::Images infrared_images = patterned_frame;
    ColorSignal::Pictures pictures;
    uint32_t first_infrared_sequence = 0, first_color_sequence = 0, first_timestamp = 0;
    uint32_t color_delay = 480;  ///< 60 ms

    /// A flat grey picture, of which the level is the frame's number modulo 256.
    SimulatedDeviceOptions();
};

/// A Kinect v2 behind no particular library: endpoints and control requests, and both streams by the clock of the bus.
/// It keeps to the protocol strictly: what comes in a wrong order or with wrong words is refused, and named in
/// complaint(). Any thread may call any function.
class SimulatedDevice {
  public:
    explicit SimulatedDevice(SimulatedDeviceOptions options = {});

    Answer control(uint8_t type, uint8_t request, uint16_t value, uint16_t index);
    Answer send(std::span<const uint8_t> bytes);
    Answer receive(std::span<uint8_t> bytes, size_t& length);
    Answer set_alternate_setting(uint8_t interface, uint8_t setting);
    Answer reset();
    uint32_t bytes_per_interval() const { return options_.commands.bytes_per_interval; }

    /// One interval of 125 us passes. `infrared` is called with the packet on the isochronous endpoint, while that is
    /// on; `color` with what a bulk transfer would bring, and returns whether the host took it.
    void pass_interval(const std::function<void(const SentPacket&)>& infrared,
                       const std::function<bool(std::span<const uint8_t>)>& color);

    /// The cable comes out. From here on everything is answered with kGone.
    void unplug() { gone_ = true; }
    /// After that many further calls of the functions above, intervals included.
    void unplug_after(uint64_t calls) { calls_left_ = calls; }
    bool gone() const { return gone_; }

    /// Exchanges what the streams do wrong, while they run.
    void set_faults(InfraredFaults infrared, ColorFaults color);
    CommandFaults& command_faults() { return options_.commands; }  ///< to be changed between calls only

    uint64_t calls() const { return calls_; }
    bool streaming_infrared() const;
    bool streaming_color() const;
    /// The last value of a colour setting that was written.
    std::optional<uint32_t> color_setting(uint32_t id) const;
    /// The first breach of the protocol; empty: none.
    std::string complaint() const;
    /// The opcodes in the order in which they came.
    std::vector<uint32_t> opcodes() const;

  private:
    bool pass_call();
    void complain(const std::string& what);
    bool strikes(std::optional<uint32_t> fault, uint32_t opcode);
    void answer(uint32_t opcode, uint32_t sequence, uint32_t most, std::span<const uint8_t> parameters);
    std::optional<std::vector<uint8_t>> payload(uint32_t opcode, std::span<const uint8_t> parameters);
    std::optional<std::vector<uint8_t>> page(uint32_t number) const;
    std::vector<uint8_t> status();
    std::vector<uint8_t> apply_setting(std::span<const uint8_t> parameters);
    void update_streams();

    SimulatedDeviceOptions options_;
    std::atomic<bool> gone_ = false;
    std::atomic<uint64_t> calls_ = 0, calls_left_ = UINT64_MAX;

    mutable std::mutex mutex_;
    bool suspended_ = false, infrared_started_ = false, color_started_ = false;
    uint8_t alternate_setting_ = 0;
    std::optional<uint32_t> next_sequence_;
    std::deque<std::vector<uint8_t>> replies_;
    std::map<uint32_t, uint32_t> color_settings_;
    std::vector<uint32_t> opcodes_;
    std::string complaint_;
    std::optional<InfraredSignal> infrared_;
    std::optional<ColorSignal> color_;
};

}  // namespace patina::sensor::kinect2::testing
