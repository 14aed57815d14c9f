#include "tools/record/raw_pass.h"

#include "reconstruction/api/access.h"

namespace patina::tools {

std::unique_ptr<cameras::Kinect2Repacker> repacker_on(std::shared_ptr<Device> device,
                                                      const sensor::RecordedSequence& raw, const std::string& where) {
    auto repacker = std::make_unique<cameras::Kinect2Repacker>(
        [device = std::move(device)]() -> vulkan::Device& { return Access::vulkan(*device); }, raw, where);
    repacker->prepare();
    return repacker;
}

RawPass::RawPass(std::shared_ptr<sensor::Recorder> recorder, std::unique_ptr<cameras::Kinect2Repacker> repacker)
    : pass_(std::move(recorder)), repacker_(std::move(repacker)) {
    if (repacker_)
        queue_.emplace([this](const sensor::RecordedFrame& raw) { return repacker_->repack(raw); },
                       [this](cameras::RawReading reading) { pass_.take(std::move(reading)); });
}

void RawPass::begin(sensor::SequenceRole role, const sensor::RecordedSequence& raw) {
    pass_.begin(role, repacker_ ? cameras::kinect2_decoded_sequence(raw) : raw);
    const std::lock_guard lock(mutex_);
    open_ = true;
}

void RawPass::take(const cameras::RawReading& reading) {
    const std::lock_guard lock(mutex_);
    if (!open_) return;
    if (queue_) {
        queue_->put(reading);
    } else {
        pass_.take(reading);
    }
}

uint64_t RawPass::end() {
    {
        const std::lock_guard lock(mutex_);
        open_ = false;
    }
    uint64_t dropped = 0;
    if (queue_) {
        queue_->drain();
        dropped = queue_->dropped() - std::exchange(dropped_before_, queue_->dropped());
    }
    pass_.end();
    return dropped;
}

}  // namespace patina::tools
