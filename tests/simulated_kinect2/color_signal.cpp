#include "tests/simulated_kinect2/color_signal.h"

#include <algorithm>
#include <utility>

#include "tests/simulated_kinect2/words.h"

namespace patina::sensor::kinect2::testing {
namespace {

constexpr size_t kTransfer = 16384;
/// What the device keeps for a host that does not fetch it.
constexpr size_t kMostWaiting = 256;

}  // namespace

std::vector<uint8_t> color_packet(const SentPicture& picture) {
    std::vector<uint8_t> packet;
    put(packet, picture.sequence);
    put(packet, 0x42424242u);
    packet.insert(packet.end(), picture.jpeg.begin(), picture.jpeg.end());
    while (packet.size() % 4 != 0) packet.push_back(0xA5);
    const uint32_t filler = (picture.filler + 3) / 4 * 4;
    packet.insert(packet.end(), filler, 0x5A);
    const auto size = static_cast<uint32_t>(packet.size() + 56);
    for (const uint32_t word : {0x39393939u, picture.sequence, filler, 0u, 0u, picture.timestamp}) put(packet, word);
    put(packet, picture.exposure_ms);
    put(packet, picture.gain);
    put(packet, 0x42424242u);
    put(packet, size);
    put(packet, picture.gamma);
    for (int i = 0; i < 3; ++i) put(packet, 0u);
    return packet;
}

ColorSignal::ColorSignal(Pictures pictures, StreamStart start, uint32_t delay, uint64_t intervals, ColorFaults faults)
    : pictures_(std::move(pictures)), start_(start), delay_(delay), faults_(std::move(faults)), interval_(intervals) {
    while (begin_of(10ull * frame_) + delay_ < interval_) ++frame_;
}

void ColorSignal::pass_interval() {
    if (interval_++ == begin_of(10ull * frame_) + delay_) send_next();
}

void ColorSignal::send_next() {
    SentPicture picture = pictures_(frame_);
    picture.sequence = start_.sequence + frame_;
    picture.timestamp = start_.timestamp + static_cast<uint32_t>(begin_of(10ull * frame_));
    std::vector<uint8_t> packet = color_packet(picture);
    if (faults_.packet) faults_.packet(frame_, packet);
    for (size_t begin = 0, index = 0; begin < packet.size(); begin += kTransfer, ++index) {
        const auto first = packet.begin() + static_cast<std::ptrdiff_t>(begin);
        const auto length = static_cast<std::ptrdiff_t>(std::min(kTransfer, packet.size() - begin));
        if (faults_.transfer && !faults_.transfer(frame_, static_cast<uint32_t>(index))) continue;
        if (transfers_.size() < kMostWaiting) transfers_.emplace_back(first, first + length);
    }
    ++frame_;
}

std::span<const uint8_t> ColorSignal::front() const {
    return transfers_.empty() ? std::span<const uint8_t>() : std::span<const uint8_t>(transfers_.front());
}

void ColorSignal::pop() { transfers_.pop_front(); }

}  // namespace patina::sensor::kinect2::testing
