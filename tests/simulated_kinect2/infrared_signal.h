#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace patina::sensor::kinect2::testing {

/// Which interval of the infrared stream: packet 0 to 8 of a sub-image, and from 9 on those without data after it.
struct PacketPlace {
    uint32_t frame = 0;  ///< since the start of the stream
    uint32_t sub_image = 0;
    uint32_t packet = 0;
};

/// What the device sends in one interval.
struct SentPacket {
    bool complete = true;  ///< false: the host sees a failed packet
    bool omitted = false;  ///< true: the host sees no interval at all
    std::span<const uint8_t> bytes;
};

struct InfraredFooter {
    uint32_t timestamp = 0, sequence = 0, sub_image = 0, length = 298496;
};

/// How the stream deviates from a faultless one. Each is called where it is set.
struct InfraredFaults {
    std::function<void(const PacketPlace&, SentPacket&)> packet;
    std::function<void(const PacketPlace&, InfraredFooter&)> footer;
};

/// Where a stream's numbers begin.
struct StreamStart {
    uint32_t sequence = 0, timestamp = 0;
};

/// The infrared stream, interval by interval: 8000 a second, 30 frames a second.
class InfraredSignal {
  public:
    /// The bytes of frame n: 10 sub-images of 298496 bytes.
    using Images = std::function<std::shared_ptr<const std::vector<uint8_t>>(uint32_t frame)>;

    InfraredSignal(Images images, StreamStart start, InfraredFaults faults);

    /// What is sent in the next interval. Its bytes stay until the next call.
    SentPacket next_interval();
    /// Which packet next_interval() returned last.
    const PacketPlace& place() const { return place_; }
    uint64_t intervals() const { return interval_; }  ///< since the start

  private:
    void begin_sub_image();
    void advance();

    Images images_;
    StreamStart start_;
    InfraredFaults faults_;
    PacketPlace place_;
    uint64_t interval_ = 0;
    bool begun_ = false;
    std::shared_ptr<const std::vector<uint8_t>> frame_;
    std::vector<uint8_t> tail_;  ///< the last packet: 40 rows and the footer
};

/// The interval, and with it the time stamp, at which a sub-image begins: 80 intervals for three of them.
constexpr uint64_t begin_of(uint64_t sub_image_since_start) { return sub_image_since_start * 80 / 3; }

/// Sub-images whose bytes differ from frame to frame and from byte to byte.
std::shared_ptr<const std::vector<uint8_t>> patterned_frame(uint32_t frame);

}  // namespace patina::sensor::kinect2::testing
