#include "sensor/kinect2/device.h"

#include <utility>

namespace patina::sensor::kinect2 {

Device::Device(std::unique_ptr<Transport> transport, DeviceOptions options)
    : transport_(std::move(transport)), options_(options), commands_(*transport_) {
    prepare(*transport_);
}

Device::~Device() {
    halt();
    try {
        if (std::exchange(running_, false)) stop_sensors(*transport_, commands_);
        say_goodbye(commands_);
    } catch (const std::exception&) {  // a device that is gone, or does not answer, is closed all the same
    }
}

void Device::start() {
    const std::lock_guard sending(sending_);
    {
        const std::lock_guard lock(mutex_);
        interrupted_ = false;
    }
    try {
        stop_run();
        start_once();
        return;
    } catch (const Unplugged&) {
        halt();
        throw;
    } catch (const Error&) {
        halt();
    }
    // A device that was left half started, by us or by another program, answers again after a reset.
    try {
        {
            const std::lock_guard lock(mutex_);
            running_ = false;
        }
        transport_->reset();
        prepare(*transport_);
        start_once();
    } catch (...) {
        halt();
        throw;
    }
}

void Device::start_once() {
    // Before the sensors: until transfers are submitted, what they send is lost.
    const auto stream =
        std::make_shared<Stream>(options_.queued_frames, options_.waiting_transfers, transport_->name());
    pages_ = start_sensors(*transport_, commands_, options_.readiness);
    calibration_ = parse_calibration(pages_, transport_->name());
    {
        const std::lock_guard lock(mutex_);
        running_ = true;
        stream_ = stream;
        if (interrupted_) stream->frames().interrupt();
    }
    transport_->start_streams(*stream);
    apply_settings();
}

void Device::apply_settings() {
    std::unique_lock lock(mutex_);
    const auto exposure = exposure_;
    const auto white_balance = white_balance_;
    lock.unlock();
    if (exposure) kinect2::set_exposure(commands_, *exposure);
    if (white_balance) kinect2::set_white_balance(commands_, *white_balance);
}

bool Device::next(RawFrame& frame) {
    const std::shared_ptr<Stream> running = stream();
    if (!running) throw Error(name(), " is not started");
    const FrameQueue::Result result = running->frames().pop(frame, options_.silence);
    if (result == FrameQueue::Result::kNothing) fail_silent(running->statistics());
    return result == FrameQueue::Result::kFrame;
}

void Device::forget_waiting() {
    if (const std::shared_ptr<Stream> running = stream()) running->frames().forget();
}

void Device::fail_silent(const StreamStatistics& statistics) const {
    const char* silent = "the two streams' time stamps do not fit";
    if (statistics.color.frames == 0) silent = "no colour picture arrived whole";
    if (statistics.infrared.frames == 0) silent = "no infrared frame arrived whole";
    throw Error(name(), ": no frame for ", options_.silence.count(), " ms: ", silent, " (", statistics.infrared.frames,
                " infrared, ", statistics.color.frames, " colour so far, ", statistics.infrared.lost_packets,
                " packets lost); patina doctor checks the USB connection");
}

void Device::stop() {
    const std::lock_guard sending(sending_);
    stop_run();
}

void Device::stop_run() {
    halt();
    {
        const std::lock_guard lock(mutex_);
        if (!std::exchange(running_, false)) return;
    }
    try {
        stop_sensors(*transport_, commands_);
    } catch (const Unplugged&) {  // then nothing is left to be stopped
    }
}

/// Ends the present run on this side alone.
void Device::halt() noexcept {
    transport_->stop_streams();
    const std::lock_guard lock(mutex_);
    if (stream_) last_run_ = stream_->statistics();
    stream_.reset();
}

std::string Device::warning() const {
    const std::string& descriptor = transport_->serial();
    if (!descriptor.empty() && !calibration_.serial.empty() && descriptor != calibration_.serial) {
        return text(name(), ": the serial number is ", descriptor, " in its descriptor, ", calibration_.serial,
                    " in its own page");
    }
    return transport_->warning();
}

void Device::interrupt() {
    const std::lock_guard lock(mutex_);
    interrupted_ = true;
    if (stream_) stream_->frames().interrupt();
}

std::shared_ptr<Stream> Device::stream() const {
    const std::lock_guard lock(mutex_);
    return stream_;
}

StreamStatistics Device::statistics() const {
    const std::lock_guard lock(mutex_);
    return stream_ ? stream_->statistics() : last_run_;
}

void Device::set_exposure(const ExposureControl& exposure) {
    check(exposure);
    const std::lock_guard sending(sending_);
    {
        const std::lock_guard lock(mutex_);
        exposure_ = exposure;
        if (!running_) return;
    }
    kinect2::set_exposure(commands_, exposure);
}

void Device::set_white_balance(const std::optional<WhiteBalanceGains>& gains) {
    check(gains);
    const std::lock_guard sending(sending_);
    {
        const std::lock_guard lock(mutex_);
        white_balance_ = gains;
        if (!running_) return;
    }
    kinect2::set_white_balance(commands_, gains);
}

WhiteBalanceGains Device::white_balance() {
    const std::lock_guard sending(sending_);
    return kinect2::white_balance(commands_);
}

}  // namespace patina::sensor::kinect2
