#include "tests/simulated_kinect2/infrared_signal.h"

#include <utility>

#include "tests/simulated_kinect2/words.h"

namespace patina::sensor::kinect2::testing {
namespace {

constexpr size_t kSubImage = 298496, kPacket = 33792, kWholePackets = 8;
constexpr uint32_t kPackets = 9;

std::vector<uint8_t> footer_bytes(const InfraredFooter& footer) {
    std::vector<uint8_t> bytes;
    for (const uint32_t word : {0u, 9u, footer.timestamp, footer.sequence, footer.sub_image, footer.length}) {
        put(bytes, word);
    }
    bytes.resize(152);
    return bytes;
}

}  // namespace

InfraredSignal::InfraredSignal(Images images, StreamStart start, InfraredFaults faults)
    : images_(std::move(images)), start_(start), faults_(std::move(faults)) {}

void InfraredSignal::begin_sub_image() {
    if (place_.sub_image == 0) frame_ = images_(place_.frame);
    const auto since_start = static_cast<uint32_t>(begin_of(10ull * place_.frame));
    InfraredFooter footer{start_.timestamp + since_start, start_.sequence + place_.frame, place_.sub_image};
    if (faults_.footer) faults_.footer(place_, footer);
    const auto rows =
        std::span(*frame_).subspan(place_.sub_image * kSubImage, kSubImage).subspan(kWholePackets * kPacket);
    tail_.assign(rows.begin(), rows.end());
    const std::vector<uint8_t> words = footer_bytes(footer);
    tail_.insert(tail_.end(), words.begin(), words.end());
}

SentPacket InfraredSignal::next_interval() {
    if (std::exchange(begun_, true)) {
        advance();
    } else {
        begin_sub_image();
    }
    SentPacket sent;
    if (place_.packet < kWholePackets) {
        sent.bytes = std::span(*frame_).subspan(place_.sub_image * kSubImage + place_.packet * kPacket, kPacket);
    } else if (place_.packet + 1 == kPackets) {
        sent.bytes = tail_;
    }
    if (faults_.packet) faults_.packet(place_, sent);
    return sent;
}

void InfraredSignal::advance() {
    ++interval_;
    ++place_.packet;
    if (interval_ < begin_of(10ull * place_.frame + place_.sub_image + 1)) return;
    place_.packet = 0;
    if (++place_.sub_image == 10) {
        place_.sub_image = 0;
        ++place_.frame;
    }
    begin_sub_image();
}

std::shared_ptr<const std::vector<uint8_t>> patterned_frame(uint32_t frame) {
    auto bytes = std::make_shared<std::vector<uint8_t>>(10 * kSubImage);
    uint32_t state = frame * 2654435761u + 12345u;
    for (uint8_t& byte : *bytes) {
        state = state * 1664525u + 1013904223u;
        byte = static_cast<uint8_t>(state >> 24);
    }
    return bytes;
}

}  // namespace patina::sensor::kinect2::testing
