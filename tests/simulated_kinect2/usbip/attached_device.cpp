#include "tests/simulated_kinect2/usbip/attached_device.h"

#include <algorithm>
#include <cerrno>
#include <optional>
#include <utility>

#include "tests/simulated_kinect2/usbip/descriptors.h"

namespace patina::sensor::kinect2::testing::usbip {
namespace {

// Standard requests, of chapter 9 of the USB specification.
constexpr uint8_t kGetStatus = 0, kClearFeature = 1, kGetDescriptor = 6, kGetConfiguration = 8, kSetConfiguration = 9;
constexpr uint8_t kSetInterface = 11, kSetExitLatency = 48, kSetIsochronousDelay = 49;
/// The delay that the driver sets; the kernel sets others.
constexpr uint16_t kDriversDelay = 40;

/// The setup packet of a control request.
struct Setup {
    uint8_t type, request;
    uint16_t value, index, length;

    explicit Setup(const std::array<uint8_t, 8>& bytes)
        : type(bytes[0]),
          request(bytes[1]),
          value(static_cast<uint16_t>(bytes[2] | bytes[3] << 8)),
          index(static_cast<uint16_t>(bytes[4] | bytes[5] << 8)),
          length(static_cast<uint16_t>(bytes[6] | bytes[7] << 8)) {}
};

/// What is read by a request that any device answers.
std::optional<std::vector<uint8_t>> standard_answer(const Setup& setup, uint32_t bytes_per_interval) {
    if (setup.request == kGetStatus) return std::vector<uint8_t>{1, 0};  // self-powered
    if (setup.request == kGetConfiguration) return std::vector<uint8_t>{1};
    if (setup.request != kGetDescriptor) return std::nullopt;
    std::vector<uint8_t> bytes = descriptor(setup.value, bytes_per_interval);
    if (bytes.empty()) return std::nullopt;
    return bytes;
}

/// The kernel's own business with every device.
bool concerns_the_bus_alone(const Setup& setup) {
    return setup.request == kClearFeature || setup.request == kSetExitLatency ||
           (setup.request == kSetIsochronousDelay && setup.value != kDriversDelay);
}

int32_t errno_of(Answer answer) {
    switch (answer) {
        case Answer::kDone: return 0;
        case Answer::kStalled: return -EPIPE;
        case Answer::kTimedOut: return -ETIMEDOUT;
        case Answer::kGone: return -ENODEV;
        case Answer::kNoBandwidth: return -ENOSPC;
    }
    return -EPROTO;
}

}  // namespace

AttachedDevice::AttachedDevice(Socket host, const BusOptions& options)
    : host_(std::move(host)),
      options_(options),
      device_(options.device_options()),
      clock_(options.frames_per_second, [this] { pass_interval(); }) {}

void AttachedDevice::serve() {
    while (std::optional<Command> command = read_command(host_)) take(*std::move(command));
}

void AttachedDevice::take(Command command) {
    const std::lock_guard lock(mutex_);
    if (command.unlink) return unlink(command);
    if (command.endpoint == 0) return control(command);
    if (command.endpoint == 2 && !command.in) return send(command);
    Queue* queue = queue_of(command);
    if (!queue) return reply(command, {.status = -EPIPE});
    queue->push_back(std::move(command));
    if (queue == &replies_) answer_pending_receives();
}

AttachedDevice::Queue* AttachedDevice::queue_of(const Command& command) {
    if (!command.in) return nullptr;
    switch (command.endpoint) {
        case 1: return &replies_;
        case 2: return &interrupt_;
        case 3: return &color_;
        case 4: return &infrared_;
        default: return nullptr;
    }
}

void AttachedDevice::unlink(const Command& command) {
    bool found = false;
    for (Queue* queue : {&replies_, &interrupt_, &color_, &infrared_}) {
        const auto transfer = std::ranges::find(*queue, command.unlinked, &Command::sequence);
        if (transfer == queue->end()) continue;
        if (queue == &infrared_ && transfer == queue->begin()) {
            filled_ = {};
            filled_packets_ = 0;
        }
        queue->erase(transfer);
        found = true;
    }
    if (!write_unlink_reply(host_, command, found)) host_.shut_down();
}

void AttachedDevice::control(const Command& command) {
    const Setup setup(command.setup);
    if (command.in) {
        std::optional<std::vector<uint8_t>> bytes = standard_answer(setup, device_.bytes_per_interval());
        if (!bytes) return reply(command, {.status = -EPIPE});
        bytes->resize(std::min<size_t>({bytes->size(), setup.length, command.length}));
        return reply(command, {.data = *std::move(bytes)});
    }
    Answer answer = Answer::kDone;
    if (setup.request == kSetConfiguration) {  // the kernel's last step after a reset
        answer = device_.reset();
    } else if (setup.request == kSetInterface) {
        const auto setting = static_cast<uint8_t>(setup.value);
        // Interface 0 has but one setting, which the kernel sets again after a reset.
        if (setup.index == 1) answer = device_.set_alternate_setting(1, setting);
    } else if (!concerns_the_bus_alone(setup)) {
        answer = device_.control(setup.type, setup.request, setup.value, setup.index);
    }
    reply(command, {.status = errno_of(answer), .actual_length = command.length});
}

void AttachedDevice::send(const Command& command) {
    const Answer answer = device_.send(command.data);
    reply(command, {.status = errno_of(answer), .actual_length = command.length});
    answer_pending_receives();
}

void AttachedDevice::answer_pending_receives() {
    while (!replies_.empty()) {
        std::vector<uint8_t> bytes(replies_.front().length);
        size_t length = 0;
        const Answer answer = device_.receive(bytes, length);
        if (answer == Answer::kTimedOut) return;  // it waits until the host takes it back
        bytes.resize(length);
        reply(replies_.front(), {.status = errno_of(answer), .data = std::move(bytes)});
        replies_.pop_front();
    }
}

void AttachedDevice::reply(const Command& command, const Reply& reply) {
    if (!write_reply(host_, command, reply)) host_.shut_down();
}

void AttachedDevice::pass_interval() {
    const bool streaming = device_.streaming_infrared();
    if (streaming && options_.unplug_after_intervals != 0 && ++intervals_ == options_.unplug_after_intervals) {
        device_.unplug();
    }
    const std::lock_guard lock(mutex_);
    device_.pass_interval([this](const SentPacket& packet) { receive(packet); },
                          [this](std::span<const uint8_t> bytes) { return receive(bytes); });
    if (device_.gone()) host_.shut_down();
}

void AttachedDevice::receive(const SentPacket& packet) {
    if (infrared_.empty()) return;
    Command& transfer = infrared_.front();
    IsochronousPacket& place = transfer.packets[filled_packets_];
    place.actual_length = std::min(static_cast<uint32_t>(packet.bytes.size()), place.length);
    place.status = packet.complete ? 0 : -EPROTO;
    filled_.data.insert(filled_.data.end(), packet.bytes.begin(), packet.bytes.begin() + place.actual_length);
    if (++filled_packets_ < transfer.packets.size()) return;
    reply(transfer, filled_);
    infrared_.pop_front();
    filled_.data.clear();
    filled_packets_ = 0;
}

bool AttachedDevice::receive(std::span<const uint8_t> bytes) {
    if (color_.empty()) return false;
    const size_t length = std::min<size_t>(bytes.size(), color_.front().length);
    reply(color_.front(), {.data = {bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(length)}});
    color_.pop_front();
    return true;
}

}  // namespace patina::sensor::kinect2::testing::usbip
