#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "sensor/kinect2/raw_frame.h"

namespace patina::sensor::kinect2 {

/// Ten sub-images of one sequence number.
struct InfraredFrame {
    uint32_t sequence = 0;
    uint32_t timestamp = 0;      ///< of sub-image 0
    std::vector<uint8_t> bytes;  ///< kInfraredBytes
};

/// What became of the stream so far.
struct InfraredStatistics {
    uint64_t frames = 0;              ///< complete ones
    uint64_t lost_frames = 0;         ///< numbers between complete ones that never became complete
    uint64_t lost_packets = 0;        ///< intervals whose data did not arrive
    uint64_t dropped_sub_images = 0;  ///< that had begun to arrive: cut short, of wrong size or number
};

/// Puts infrared frames together from isochronous packets: sub-images of 298496 bytes and a footer of 152, with packets
/// of length 0 between them. A frame is complete, or it is dropped as a whole: one lost packet costs its frame, and no
/// other. Nothing is copied but each packet once, to its place in the frame.
class InfraredAssembler {
  public:
    InfraredAssembler() : frame_(kInfraredBytes) {}

    /// Takes the packet of the next interval. True: it completes a frame, which take() has until the next call.
    bool add(bool complete, std::span<const uint8_t> packet);

    /// Exchanges the complete frame's buffer for that of `frame`.
    void take(InfraredFrame& frame);

    const InfraredStatistics& statistics() const { return statistics_; }

  private:
    static constexpr size_t kFooterBytes = 152;

    struct Footer {
        explicit Footer(std::span<const uint8_t> bytes);
        uint32_t timestamp, sequence, sub_image, length;
    };

    void boundary();
    void drop();
    uint8_t* place(uint32_t sub_image) { return frame_.data() + sub_image * kSubImageBytes; }
    bool finish_sub_image(const Footer& footer);
    void begin_frame(uint32_t sequence);
    bool finish_frame();

    std::vector<uint8_t> frame_;
    /// Where the sub-image that arrives is written: the first place still free, which is nearly always its own. Its
    /// number is known at its end only.
    uint32_t slot_ = 0;
    size_t collected_ = 0;   ///< bytes of it
    bool skipping_ = false;  ///< until the next boundary

    uint32_t present_ = 0;  ///< bit k: sub-image k of the frame has arrived
    uint32_t sequence_ = 0, timestamp_ = 0;
    std::optional<uint32_t> last_complete_;
    InfraredStatistics statistics_;
};

}  // namespace patina::sensor::kinect2
