#include "sensor/kinect2/infrared_assembler.h"

#include <bit>
#include <cstring>

#include "sensor/kinect2/little_endian.h"
#include "sensor/kinect2/sequence.h"

namespace patina::sensor::kinect2 {
namespace {

constexpr uint32_t kAllPresent = (1u << kSubImages) - 1;

}  // namespace

InfraredAssembler::Footer::Footer(std::span<const uint8_t> bytes)
    : timestamp(read_at<uint32_t>(bytes, 8)),
      sequence(read_at<uint32_t>(bytes, 12)),
      sub_image(read_at<uint32_t>(bytes, 16)),
      length(read_at<uint32_t>(bytes, 20)) {}

bool InfraredAssembler::add(bool complete, std::span<const uint8_t> packet) {
    if (!complete) {
        ++statistics_.lost_packets;
        drop();
        return false;
    }
    if (packet.empty()) {
        boundary();
        return false;
    }
    if (skipping_) return false;
    const size_t total = collected_ + packet.size();
    const bool last = total == kSubImageBytes + kFooterBytes;
    if ((total > kSubImageBytes && !last) || (last && packet.size() < kFooterBytes)) {
        drop();
        return false;
    }
    const size_t image_bytes = packet.size() - (last ? kFooterBytes : 0);
    std::memcpy(place(slot_) + collected_, packet.data(), image_bytes);
    collected_ += image_bytes;
    return last && finish_sub_image(Footer(packet.last(kFooterBytes)));
}

void InfraredAssembler::boundary() {
    if (collected_ > 0) ++statistics_.dropped_sub_images;
    collected_ = 0;
    skipping_ = false;
}

// What follows until the next boundary belongs to the damaged sub-image.
void InfraredAssembler::drop() {
    if (collected_ > 0) ++statistics_.dropped_sub_images;
    collected_ = 0;
    skipping_ = true;
}

bool InfraredAssembler::finish_sub_image(const Footer& footer) {
    collected_ = 0;
    if (footer.length != kSubImageBytes || footer.sub_image >= kSubImages) {
        ++statistics_.dropped_sub_images;
        return false;
    }
    if (present_ == 0 && last_complete_ == footer.sequence) return false;  // repeats part of a frame that is out
    if (present_ == 0 || footer.sequence != sequence_) begin_frame(footer.sequence);
    if (footer.sub_image != slot_) std::memcpy(place(footer.sub_image), place(slot_), kSubImageBytes);
    if (footer.sub_image == 0) timestamp_ = footer.timestamp;
    present_ |= 1u << footer.sub_image;
    if (present_ == kAllPresent) return finish_frame();
    slot_ = static_cast<uint32_t>(std::countr_one(present_));
    return false;
}

void InfraredAssembler::begin_frame(uint32_t sequence) {
    sequence_ = sequence;
    present_ = 0;
}

bool InfraredAssembler::finish_frame() {
    ++statistics_.frames;
    if (last_complete_) statistics_.lost_frames += numbers_between(*last_complete_, sequence_);
    last_complete_ = sequence_;
    present_ = 0;
    slot_ = 0;
    return true;
}

void InfraredAssembler::take(InfraredFrame& frame) {
    frame.sequence = sequence_;
    frame.timestamp = timestamp_;
    frame.bytes.resize(kInfraredBytes);
    frame.bytes.swap(frame_);
}

}  // namespace patina::sensor::kinect2
