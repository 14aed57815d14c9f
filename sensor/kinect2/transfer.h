#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace patina::sensor::kinect2 {

/// The two streams of the device: colour in bulk transfers, infrared in isochronous ones.
enum class StreamKind { kColor, kInfrared };

/// The longest packet of an isochronous interval: 48 rows of a sub-image.
inline constexpr size_t kInfraredPacketBytes = 33792;
inline constexpr size_t kInfraredPacketsPerTransfer = 8;
inline constexpr size_t kColorTransferBytes = 16384;

/// What one interval, or one bulk transfer, brought.
struct Packet {
    bool complete = false;  ///< false: lost, its bytes mean nothing
    uint32_t length = 0;    ///< 0: an interval in which the device had nothing to send
};

/// A buffer of one USB transfer. It moves between the USB layer and the assemblers; its bytes are not copied in
/// between.
struct Transfer {
    StreamKind kind = StreamKind::kColor;
    std::vector<uint8_t> bytes;   ///< packet k starts at k * stride()
    std::vector<Packet> packets;  ///< of colour, one
    bool follows_gap = false;     ///< data was lost between the transfer before and this one

    explicit Transfer(StreamKind stream = StreamKind::kColor)
        : kind(stream),
          bytes(stream == StreamKind::kColor ? kColorTransferBytes
                                             : kInfraredPacketBytes * kInfraredPacketsPerTransfer),
          packets(stream == StreamKind::kColor ? 1 : kInfraredPacketsPerTransfer) {}

    size_t stride() const { return bytes.size() / packets.size(); }
    /// The bytes of packet k; no more than fit, whatever its length claims.
    std::span<const uint8_t> packet(size_t k) const {
        return std::span(bytes).subspan(k * stride(), std::min<size_t>(packets[k].length, stride()));
    }
};

}  // namespace patina::sensor::kinect2
