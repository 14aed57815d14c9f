#include "sensor/kinect2/color_assembler.h"

#include "sensor/kinect2/little_endian.h"
#include "sensor/kinect2/sequence.h"

namespace patina::sensor::kinect2 {
namespace {

constexpr size_t kHeaderBytes = 8;
constexpr size_t kFooterBytes = 56;
constexpr size_t kMostPadding = 3;
constexpr uint32_t kHeaderMagic = 0x42424242;
constexpr uint32_t kFooterMagics[] = {0x39393939, 0x42424242};

using Bytes = std::span<const uint8_t>;

bool ends_with_footer(Bytes collected) {
    if (collected.size() < kHeaderBytes + kFooterBytes) return false;
    const Bytes footer = collected.last(kFooterBytes);
    return read_at<uint32_t>(footer, 0) == kFooterMagics[0] && read_at<uint32_t>(footer, 32) == kFooterMagics[1];
}

/// The packet that ends with the footer; empty where the sizes disagree. What lies before it is left of a packet that
/// lost its end.
Bytes last_packet(Bytes collected) {
    const auto size = read_at<uint32_t>(collected.last(kFooterBytes), 36);
    return size >= kHeaderBytes + kFooterBytes && size <= collected.size() ? collected.last(size) : Bytes{};
}

/// The JPEG between header and filler; empty where there is none.
Bytes jpeg_of(Bytes packet) {
    const Bytes footer = packet.last(kFooterBytes);
    if (read_at<uint32_t>(packet, 4) != kHeaderMagic) return {};
    if (read_at<uint32_t>(packet, 0) != read_at<uint32_t>(footer, 4)) return {};
    Bytes jpeg = packet.subspan(kHeaderBytes, packet.size() - kHeaderBytes - kFooterBytes);
    const auto filler = read_at<uint32_t>(footer, 8);
    if (filler > jpeg.size()) return {};
    jpeg = jpeg.first(jpeg.size() - filler);
    for (size_t padding = 0; padding <= kMostPadding && jpeg.size() >= 4; ++padding) {
        if (jpeg[jpeg.size() - 2] == 0xFF && jpeg[jpeg.size() - 1] == 0xD9) {
            return jpeg[0] == 0xFF && jpeg[1] == 0xD8 ? jpeg : Bytes{};
        }
        jpeg = jpeg.first(jpeg.size() - 1);
    }
    return {};
}

ColorFrame described_by(Bytes footer) {
    ColorFrame frame;
    frame.sequence = read_at<uint32_t>(footer, 4);
    frame.timestamp = read_at<uint32_t>(footer, 20);
    frame.exposure_ms = read_at<float>(footer, 24);
    frame.gain = read_at<float>(footer, 28);
    frame.gamma = read_at<float>(footer, 40);
    return frame;
}

}  // namespace

bool ColorAssembler::add(bool complete, std::span<const uint8_t> transfer) {
    if (!complete) ++statistics_.lost_transfers;
    if (done_ || !complete || collected_.size() + transfer.size() > kMostBytes) collected_.clear();
    done_ = false;
    if (!complete || transfer.size() > kMostBytes) return false;
    collected_.insert(collected_.end(), transfer.begin(), transfer.end());
    if (!ends_with_footer(collected_)) return false;
    done_ = true;
    const Bytes packet = last_packet(collected_);
    jpeg_ = packet.empty() ? Bytes{} : jpeg_of(packet);
    if (jpeg_.empty()) {
        ++statistics_.dropped_packets;
        return false;
    }
    complete_ = described_by(packet.last(kFooterBytes));
    ++statistics_.frames;
    if (last_complete_) statistics_.lost_frames += numbers_between(*last_complete_, complete_.sequence);
    last_complete_ = complete_.sequence;
    return true;
}

void ColorAssembler::take(ColorFrame& frame) const {
    std::vector<uint8_t> bytes = std::move(frame.jpeg);
    bytes.assign(jpeg_.begin(), jpeg_.end());
    frame = complete_;
    frame.jpeg = std::move(bytes);
}

}  // namespace patina::sensor::kinect2
