#include "sensor/kinect2/usb_streams.h"

#include <new>
#include <utility>

#include <pthread.h>

namespace patina::sensor::kinect2::usb {
namespace {

using namespace std::chrono_literals;

// 60 x 8 packets and 20 x 16 KiB are 16.55 MB, just below what Linux gives all of USB by default (16 MiB). The infrared
// ring lasts for 60 ms.
constexpr size_t kColorTransfers = 20, kInfraredTransfers = 60;
/// 16 ms of infrared and a third of a picture: with less, any delay of the event thread would lose data.
constexpr size_t kFewestColor = 8, kFewestInfrared = 16;
constexpr auto kTransferTime = 1ms;  // 8 intervals of 125 us
/// A stream whose transfers all fail ends instead of spinning.
constexpr uint32_t kMostFailures = 200;
constexpr auto kMostForCancelling = 5s;

/// Delays of this thread lose data, those of others do not. Where the system does not allow it, all stays as it is.
void raise_priority() {
    sched_param parameters{};
    parameters.sched_priority = sched_get_priority_min(SCHED_RR);
    pthread_setschedparam(pthread_self(), SCHED_RR, &parameters);
}

}  // namespace

Streams::Slot::Slot(Streams& owner, libusb_device_handle* handle, StreamKind kind)
    : streams(owner),
      buffer(kind),
      transfer(libusb_alloc_transfer(kind == StreamKind::kColor ? 0 : static_cast<int>(kInfraredPacketsPerTransfer))) {
    if (!transfer) throw std::bad_alloc();
    fill(handle);
}

void Streams::Slot::fill(libusb_device_handle* handle) {
    const auto length = static_cast<int>(buffer.bytes.size());
    if (buffer.kind == StreamKind::kColor) {
        libusb_fill_bulk_transfer(transfer.get(), handle, kColorEndpoint, buffer.bytes.data(), length, completed, this,
                                  0);
    } else {
        libusb_fill_iso_transfer(transfer.get(), handle, kInfraredEndpoint, buffer.bytes.data(), length,
                                 static_cast<int>(buffer.packets.size()), completed, this, 0);
        libusb_set_iso_packet_lengths(transfer.get(), static_cast<unsigned>(buffer.stride()));
    }
}

/// What the transfer brought, packet by packet.
void Streams::Slot::read_result() {
    const bool complete = transfer->status == LIBUSB_TRANSFER_COMPLETED;
    buffer.follows_gap = std::exchange(follows_gap, false);
    if (buffer.kind == StreamKind::kColor) {
        buffer.packets[0] = {complete, static_cast<uint32_t>(transfer->actual_length)};
        return;
    }
    for (size_t k = 0; k < buffer.packets.size(); ++k) {
        const libusb_iso_packet_descriptor& packet = transfer->iso_packet_desc[k];
        buffer.packets[k] = {complete && packet.status == LIBUSB_TRANSFER_COMPLETED, packet.actual_length};
    }
}

Streams::Streams(libusb_context* context, libusb_device_handle* handle, TransferSink& sink, std::string name)
    : context_(context), sink_(sink), name_(std::move(name)) {
    add_slots(StreamKind::kColor, kColorTransfers, handle);
    add_slots(StreamKind::kInfrared, kInfraredTransfers, handle);
}

void Streams::start() {
    thread_ = std::thread([this] { handle_events(); });
    submit_all(StreamKind::kColor);
    submit_all(StreamKind::kInfrared);
}

void Streams::add_slots(StreamKind kind, size_t count, libusb_device_handle* handle) {
    Ring& all = ring(kind);
    all.idle.reserve(count);  // the event thread allocates nothing
    for (size_t i = 0; i < count; ++i) all.slots.push_back(std::make_unique<Slot>(*this, handle, kind));
}

void Streams::submit_all(StreamKind kind) {
    const bool color = kind == StreamKind::kColor;
    const std::lock_guard lock(mutex_);
    Ring& all = ring(kind);
    size_t submitted = 0;
    int code = 0;
    for (; submitted < all.slots.size(); ++submitted) {
        code = submit(*all.slots[submitted]);
        if (code < 0) break;
    }
    if (code == 0) return;
    const std::string granted =
        text(submitted, " of ", all.slots.size(), color ? " colour" : " infrared", " transfers");
    if (code == LIBUSB_ERROR_NO_DEVICE) throw Unplugged(name_, " was unplugged");
    if (submitted < (color ? kFewestColor : kFewestInfrared)) {
        throw Error(name_, ": only ", granted, " could be submitted (", libusb_strerror(code),
                    "); boot with usbcore.usbfs_memory_mb=64, patina doctor shows the present limit");
    }
    warning_ = text(name_, ": only ", granted,
                    " fit into the system's USB memory; with usbcore.usbfs_memory_mb=64 fewer frames are lost");
}

int Streams::submit(Slot& slot) {
    slot.transfer->buffer = slot.buffer.bytes.data();  // another one after each exchange
    const int code = libusb_submit_transfer(slot.transfer.get());
    if (code == 0) ++ring(slot.buffer.kind).in_flight;
    return code;
}

void Streams::completed(libusb_transfer* transfer) {
    Slot& slot = *static_cast<Slot*>(transfer->user_data);
    slot.streams.on_completed(slot);
}

void Streams::on_completed(Slot& slot) {
    {
        const std::lock_guard lock(mutex_);
        --ring(slot.buffer.kind).in_flight;
        returned_.notify_all();
        if (stopping_ || ended_) return;
    }
    if (slot.transfer->status == LIBUSB_TRANSFER_NO_DEVICE) return end(true, {});
    slot.read_result();
    sink_.exchange(slot.buffer);
    submit_again(slot);
}

/// Whether the ring of infrared transfers, with so many besides the one that has just completed, may have run dry since
/// the last one completed: three quarters of the time that it lasts have passed. The transfers that were in flight are
/// still whole and in order; data is missing before the one that is submitted next.
bool Streams::stalled(size_t in_flight) {
    const auto now = std::chrono::steady_clock::now();
    const auto last = std::exchange(last_infrared_, now);
    return last.time_since_epoch().count() != 0 && now - last > kTransferTime * in_flight * 3 / 4;
}

void Streams::submit_again(Slot& slot) {
    std::unique_lock lock(mutex_);
    if (stopping_) return;
    Ring& all = ring(slot.buffer.kind);
    if (slot.buffer.kind == StreamKind::kInfrared) slot.follows_gap = stalled(all.in_flight);
    const bool failed = slot.transfer->status != LIBUSB_TRANSFER_COMPLETED;
    all.failures = failed ? all.failures + 1 : 0;
    all.idle.push_back(&slot);
    int code = 0;
    while (!all.idle.empty() && code == 0) {
        code = submit(*all.idle.back());
        if (code == 0) all.idle.pop_back();
    }
    const bool unplugged = code == LIBUSB_ERROR_NO_DEVICE;
    if (!unplugged && all.in_flight > 0 && all.failures < kMostFailures) return;
    lock.unlock();
    end(unplugged, code < 0 ? libusb_strerror(code) : "all transfers fail");
}

void Streams::end(bool unplugged, const std::string& reason) {
    {
        const std::lock_guard lock(mutex_);
        if (stopping_ || std::exchange(ended_, true)) return;
    }
    sink_.end(unplugged, reason);
}

bool Streams::stop() noexcept {
    {
        const std::lock_guard lock(mutex_);
        stopping_ = true;
    }
    for (Ring* all : {&color_, &infrared_}) {
        for (const auto& slot : all->slots)
            libusb_cancel_transfer(slot->transfer.get());  // those at rest are not found
    }
    bool all_returned = false;
    {
        std::unique_lock lock(mutex_);
        all_returned =
            returned_.wait_for(lock, kMostForCancelling, [&] { return color_.in_flight + infrared_.in_flight == 0; });
    }
    quit_ = true;
    libusb_interrupt_event_handler(context_);
    if (thread_.joinable()) thread_.join();
    return all_returned;
}

void Streams::handle_events() {
    raise_priority();
    while (!quit_) {
        timeval patience{0, 100'000};
        const int code = libusb_handle_events_timeout_completed(context_, &patience, nullptr);
        if (code < 0 && code != LIBUSB_ERROR_INTERRUPTED) std::this_thread::sleep_for(10ms);
    }
}

}  // namespace patina::sensor::kinect2::usb
