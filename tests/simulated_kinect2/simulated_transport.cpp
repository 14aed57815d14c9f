#include "tests/simulated_kinect2/simulated_transport.h"

#include <algorithm>
#include <utility>

namespace patina::sensor::kinect2::testing {

SimulatedTransport::SimulatedTransport(std::shared_ptr<SimulatedDevice> device, Clock clock)
    : device_(std::move(device)), clock_(clock) {}

void SimulatedTransport::expect(Answer answer) const {
    switch (answer) {
        case Answer::kDone: return;
        case Answer::kGone: throw Unplugged(name_, " was unplugged");
        case Answer::kStalled: throw Stalled(name_, " refused");
        case Answer::kTimedOut: throw Error(name_, ": timeout");
        case Answer::kNoBandwidth: throw Error(name_, ": no bandwidth");
    }
}

void SimulatedTransport::control(const ControlRequest& request) {
    expect(device_->control(request.type, request.request, request.value, request.index));
}

void SimulatedTransport::send(std::span<const uint8_t> bytes) { expect(device_->send(bytes)); }

size_t SimulatedTransport::receive(std::span<uint8_t> bytes) {
    size_t length = 0;
    expect(device_->receive(bytes, length));
    return length;
}

void SimulatedTransport::set_alternate_setting(uint8_t interface, uint8_t setting) {
    expect(device_->set_alternate_setting(interface, setting));
}

void SimulatedTransport::reset() { expect(device_->reset()); }

void SimulatedTransport::start_streams(TransferSink& sink) {
    if (device_->gone()) expect(Answer::kGone);
    sink_ = &sink;
    filled_ = 0;
    exchanges_ = 0;
    ended_ = false;
    if (clock_ == Clock::kByHand) return;
    thread_ = std::jthread([this](const std::stop_token& stop) {
        while (!stop.stop_requested() && !ended_) pass_interval();
    });
}

void SimulatedTransport::stop_streams() noexcept {
    thread_ = {};
    sink_ = nullptr;
}

void SimulatedTransport::pass(uint64_t intervals) {
    for (uint64_t i = 0; i < intervals && sink_; ++i) pass_interval();
}

void SimulatedTransport::pass_asleep(uint64_t intervals) {
    asleep_ = true;
    pass(intervals);
    asleep_ = false;
    for (Transfer& transfer : kept_) hand_over(transfer);
    kept_.clear();
}

void SimulatedTransport::pass_interval() {
    device_->pass_interval([this](const SentPacket& packet) { fill_infrared(packet); },
                           [this](std::span<const uint8_t> bytes) {
                               fill_color(bytes);
                               return true;
                           });
    if (device_->gone() && !std::exchange(ended_, true)) sink_->end(true, {});
}

void SimulatedTransport::fill_infrared(const SentPacket& packet) {
    std::ranges::copy(packet.bytes,
                      infrared_.bytes.begin() + static_cast<std::ptrdiff_t>(filled_ * infrared_.stride()));
    infrared_.packets[filled_] = {packet.complete, static_cast<uint32_t>(packet.bytes.size())};
    if (++filled_ < infrared_.packets.size()) return;
    filled_ = 0;
    hand_over(infrared_);
}

void SimulatedTransport::fill_color(std::span<const uint8_t> bytes) {
    std::ranges::copy(bytes, color_.bytes.begin());
    color_.packets[0] = {true, static_cast<uint32_t>(bytes.size())};
    hand_over(color_);
}

void SimulatedTransport::hand_over(Transfer& transfer) {
    if (asleep_) {
        kept_.push_back(transfer);
        return;
    }
    ++exchanges_;
    sink_->exchange(transfer);
}

}  // namespace patina::sensor::kinect2::testing
