#include "sensor/kinect2/stream.h"

#include <utility>

namespace patina::sensor::kinect2 {
Stream::Stream(size_t queued_frames, size_t waiting_transfers, std::string name)
    : frames_(queued_frames), name_(std::move(name)) {
    for (size_t i = 0; i < waiting_transfers; ++i) {
        color_spares_.transfers.emplace_back(StreamKind::kColor);
        infrared_spares_.transfers.emplace_back(StreamKind::kInfrared);
    }
    filled_.reserve(2 * waiting_transfers);  // so that exchange() allocates nothing
    thread_ = std::jthread([this](std::stop_token stop) { run(stop); });
}

Stream::~Stream() = default;

void Stream::exchange(Transfer& transfer) noexcept {
    const std::lock_guard lock(mutex_);
    Spares& spare = spares(transfer.kind);
    if (spare.transfers.empty()) {
        spare.lost_one = true;
        ++statistics_.overruns;
        return;
    }
    std::swap(transfer, spare.transfers.back());
    filled_.push_back(std::move(spare.transfers.back()));
    spare.transfers.pop_back();
    filled_.back().follows_gap |= std::exchange(spare.lost_one, false);
    changed_.notify_one();
}

void Stream::end(bool unplugged, const std::string& reason) noexcept {
    const std::lock_guard lock(mutex_);
    if (ending_) return;
    ending_ = unplugged ? std::make_exception_ptr(Unplugged(name_, " was unplugged"))
                        : std::make_exception_ptr(Error(name_, ": the streams ended: ", reason));
    changed_.notify_one();
}

void Stream::run(const std::stop_token& stop) {
    try {
        std::vector<Transfer> work;
        work.reserve(filled_.capacity());
        while (wait_for_work(stop, work)) {
            for (Transfer& transfer : work) {
                assemble(transfer);
                give_back(std::move(transfer));
            }
            transfers_ += work.size();
            work.clear();
            publish_statistics();
        }
        const std::lock_guard lock(mutex_);
        if (ending_) frames_.close(ending_);
    } catch (...) {
        frames_.close(std::current_exception());
    }
}

/// False: no more work comes.
bool Stream::wait_for_work(const std::stop_token& stop, std::vector<Transfer>& work) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, stop, [&] { return !filled_.empty() || ending_; });
    if (stop.stop_requested()) return false;
    work.swap(filled_);
    return !work.empty();
}

void Stream::assemble(const Transfer& transfer) {
    const auto add = transfer.kind == StreamKind::kColor ? &Stream::add_color : &Stream::add_infrared;
    if (transfer.follows_gap) (this->*add)(false, {});
    for (size_t k = 0; k < transfer.packets.size(); ++k) (this->*add)(transfer.packets[k].complete, transfer.packet(k));
}

void Stream::add_infrared(bool complete, std::span<const uint8_t> packet) {
    if (!infrared_.add(complete, packet)) return;
    InfraredFrame frame = pairer_.spare_infrared();
    infrared_.take(frame);
    pairer_.add(std::move(frame));
    hand_out_pairs();
}

void Stream::add_color(bool complete, std::span<const uint8_t> transfer) {
    if (!color_.add(complete, transfer)) return;
    ColorFrame frame = pairer_.spare_color();
    color_.take(frame);
    pairer_.add(std::move(frame));
    hand_out_pairs();
}

void Stream::hand_out_pairs() {
    while (pairer_.next(spare_)) {
        ++pairs_;
        spare_ = frames_.push(std::move(spare_));
    }
}

void Stream::give_back(Transfer transfer) {
    transfer.follows_gap = false;
    const std::lock_guard lock(mutex_);
    spares(transfer.kind).transfers.push_back(std::move(transfer));
}

void Stream::publish_statistics() {
    const std::lock_guard lock(mutex_);
    statistics_.infrared = infrared_.statistics();
    statistics_.color = color_.statistics();
    statistics_.transfers = transfers_;
    statistics_.frames = pairs_;
    statistics_.unpaired_infrared = pairer_.unpaired_infrared();
    statistics_.unpaired_color = pairer_.unpaired_color();
}

StreamStatistics Stream::statistics() const {
    StreamStatistics statistics;
    {
        const std::lock_guard lock(mutex_);
        statistics = statistics_;
    }
    statistics.dropped_frames = frames_.dropped();
    return statistics;
}

}  // namespace patina::sensor::kinect2
