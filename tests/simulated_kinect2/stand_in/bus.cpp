#include "tests/simulated_kinect2/stand_in/bus.h"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <fstream>
#include <utility>

namespace patina::sensor::kinect2::testing {
namespace {

constexpr uint64_t kSubmissionsBeforeFailures = 200;

}  // namespace

Bus::Bus(const BusOptions& options)
    : options_(options),
      device_(options.device_options()),
      clock_(options.frames_per_second, [this] { pass_interval(); }) {}

void Bus::pass_interval() {
    const bool streaming = device_.streaming_infrared();
    constexpr uint64_t kLook = 100;  // intervals, some 12 ms
    if (streaming && !device_.gone()) {
        ++intervals_;
        const bool asked =
            !options_.unplug_file.empty() && intervals_ % kLook == 0 && std::filesystem::exists(options_.unplug_file);
        if (asked) std::ofstream(options_.unplug_file.string() + ".sent") << intervals_ * 3 / 800;
        if (asked || (options_.unplug_after_intervals != 0 && intervals_ == options_.unplug_after_intervals))
            device_.unplug();
    }
    device_.pass_interval([this](const SentPacket& packet) { receive(packet); },
                          [this](std::span<const uint8_t> bytes) { return receive(bytes); });
    if (device_.gone()) complete_all(LIBUSB_TRANSFER_NO_DEVICE);
}

void Bus::receive(const SentPacket& packet) {
    const std::lock_guard lock(mutex_);
    if (isochronous_.empty() || hung_) return;
    libusb_transfer& transfer = *isochronous_.front();
    libusb_iso_packet_descriptor& descriptor = transfer.iso_packet_desc[filled_];
    const size_t length = std::min<size_t>(packet.bytes.size(), descriptor.length);
    std::copy_n(packet.bytes.begin(), length, transfer.buffer + static_cast<size_t>(filled_) * descriptor.length);
    descriptor.actual_length = static_cast<unsigned>(length);
    descriptor.status = packet.complete ? LIBUSB_TRANSFER_COMPLETED : LIBUSB_TRANSFER_ERROR;
    if (++filled_ < transfer.num_iso_packets) return;
    complete(isochronous_, LIBUSB_TRANSFER_COMPLETED);
}

bool Bus::receive(std::span<const uint8_t> bytes) {
    const std::lock_guard lock(mutex_);
    if (bulk_.empty() || hung_) return false;
    libusb_transfer& transfer = *bulk_.front();
    const size_t length = std::min<size_t>(bytes.size(), static_cast<size_t>(transfer.length));
    std::memcpy(transfer.buffer, bytes.data(), length);
    transfer.actual_length = static_cast<int>(length);
    complete(bulk_, LIBUSB_TRANSFER_COMPLETED);
    return true;
}

void Bus::complete(std::deque<libusb_transfer*>& queue, libusb_transfer_status status) {
    if (&queue == &isochronous_) filled_ = 0;
    completed_.push_back({queue.front(), status});
    queue.pop_front();
    changed_.notify_all();
}

void Bus::complete_all(libusb_transfer_status status) {
    const std::lock_guard lock(mutex_);
    for (auto* queue : {&isochronous_, &bulk_}) {
        while (!queue->empty()) complete(*queue, status);
    }
}

std::deque<libusb_transfer*>& Bus::queue_of(const libusb_transfer* transfer) {
    return transfer->type == LIBUSB_TRANSFER_TYPE_ISOCHRONOUS ? isochronous_ : bulk_;
}

int Bus::submit(libusb_transfer* transfer) {
    if (device_.gone()) return LIBUSB_ERROR_NO_DEVICE;
    const std::lock_guard lock(mutex_);
    const auto length = static_cast<uint64_t>(transfer->length);
    if (bytes_in_use_ + length > options_.usbfs_bytes) return LIBUSB_ERROR_NO_MEM;
    if (++submissions_ > kSubmissionsBeforeFailures &&
        submissions_ <= kSubmissionsBeforeFailures + options_.transient_failures) {
        return LIBUSB_ERROR_NO_MEM;
    }
    bytes_in_use_ += length;
    queue_of(transfer).push_back(transfer);
    return 0;
}

int Bus::cancel(libusb_transfer* transfer) {
    const std::lock_guard lock(mutex_);
    auto& queue = queue_of(transfer);
    const auto found = std::ranges::find(queue, transfer);
    if (found == queue.end()) return LIBUSB_ERROR_NOT_FOUND;
    hung_ |= options_.cancel_hangs;
    if (hung_) return 0;
    if (&queue == &isochronous_ && found == queue.begin()) filled_ = 0;
    queue.erase(found);
    completed_.push_back({transfer, LIBUSB_TRANSFER_CANCELLED});
    changed_.notify_all();
    return 0;
}

void Bus::handle_events(const timeval& patience) {
    std::vector<Completion> completions;
    {
        std::unique_lock lock(mutex_);
        changed_.wait_for(lock, std::chrono::seconds(patience.tv_sec) + std::chrono::microseconds(patience.tv_usec),
                          [&] { return interrupted_ || !completed_.empty(); });
        interrupted_ = false;
        completions.swap(completed_);
        for (const Completion& completion : completions) {
            bytes_in_use_ -= static_cast<uint64_t>(completion.transfer->length);
        }
    }
    for (const Completion& completion : completions) {
        completion.transfer->status = completion.status;
        completion.transfer->callback(completion.transfer);
    }
}

void Bus::interrupt() {
    const std::lock_guard lock(mutex_);
    interrupted_ = true;
    changed_.notify_all();
}

void Bus::forget_transfers() {
    const std::lock_guard lock(mutex_);
    isochronous_.clear();
    bulk_.clear();
    completed_.clear();
    filled_ = 0;
    bytes_in_use_ = 0;
    hung_ = false;
}

}  // namespace patina::sensor::kinect2::testing
