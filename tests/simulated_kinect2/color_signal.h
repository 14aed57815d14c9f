#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "tests/simulated_kinect2/infrared_signal.h"

namespace patina::sensor::kinect2::testing {

/// A colour picture and what its footer says.
struct SentPicture {
    std::vector<uint8_t> jpeg;
    uint32_t sequence = 0, timestamp = 0;
    float exposure_ms = 10, gain = 1, gamma = 1;
    uint32_t filler = 0;  ///< bytes; more are added until the packet's size is a multiple of 4
};

/// A colour packet: header, JPEG, padding, filler, footer.
std::vector<uint8_t> color_packet(const SentPicture& picture);

/// How the stream deviates from a faultless one.
struct ColorFaults {
    /// Called with each packet before it is cut into transfers.
    std::function<void(uint32_t frame, std::vector<uint8_t>& packet)> packet;
    /// Called with each transfer: false drops it.
    std::function<bool(uint32_t frame, uint32_t transfer)> transfer;
};

/// The colour stream: 30 pictures a second, each some time after it was taken, in transfers of up to 16384 bytes.
class ColorSignal {
  public:
    /// Picture n, of which sequence and time stamp are set here.
    using Pictures = std::function<SentPicture(uint32_t frame)>;

    /// `delay`: intervals of 125 us between a picture's time stamp and its first transfer. `intervals`: how many have
    /// passed on the device's clock; the first picture is the next that is due.
    ColorSignal(Pictures pictures, StreamStart start, uint32_t delay, uint64_t intervals, ColorFaults faults);

    /// One interval passes. Afterwards front() has what a bulk transfer brings, where there is something.
    void pass_interval();
    /// The next transfer's bytes; empty when there is none. They stay until pop().
    std::span<const uint8_t> front() const;
    void pop();

  private:
    void send_next();

    Pictures pictures_;
    StreamStart start_;
    uint32_t delay_;
    ColorFaults faults_;
    uint64_t interval_;
    uint32_t frame_ = 0;
    std::deque<std::vector<uint8_t>> transfers_;
};

}  // namespace patina::sensor::kinect2::testing
