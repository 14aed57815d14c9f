#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "sensor/kinect2/raw_frame.h"

namespace patina::sensor::kinect2 {

/// A colour picture with what the camera says about it.
struct ColorFrame {
    uint32_t sequence = 0;
    uint32_t timestamp = 0;  ///< in ticks
    float exposure_ms = 0, gain = 0, gamma = 0;
    std::vector<uint8_t> jpeg;  ///< FF D8 to FF D9
};

/// What became of the stream so far.
struct ColorStatistics {
    uint64_t frames = 0;           ///< complete ones
    uint64_t lost_frames = 0;      ///< numbers between complete ones that never became complete
    uint64_t lost_transfers = 0;   ///< whose data did not arrive
    uint64_t dropped_packets = 0;  ///< whose sizes, numbers or JPEG disagree
};

/// Puts colour pictures together from bulk transfers. A packet is a header of 8 bytes, a JPEG, padding, filler and a
/// footer of 56 bytes; it ends where the last 56 bytes of what was collected are a footer. The data is never searched
/// for its magic words: a lost transfer shows as a size that disagrees. A lost transfer costs its own picture, even
/// when it held the footer.
class ColorAssembler {
  public:
    ColorAssembler() { collected_.reserve(kMostBytes); }

    /// Takes the next transfer. True: it completes a picture, which take() has until the next call.
    bool add(bool complete, std::span<const uint8_t> transfer);

    /// Copies the complete picture into `frame`, whose buffer is reused.
    void take(ColorFrame& frame) const;

    const ColorStatistics& statistics() const { return statistics_; }

  private:
    static constexpr size_t kMostBytes = size_t{2} << 20;

    std::vector<uint8_t> collected_;
    bool done_ = false;              ///< what was collected is a packet that is complete
    ColorFrame complete_;            ///< without its bytes
    std::span<const uint8_t> jpeg_;  ///< these, in collected_
    std::optional<uint32_t> last_complete_;
    ColorStatistics statistics_;
};

}  // namespace patina::sensor::kinect2
