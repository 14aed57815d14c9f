#include "sensor/look_ahead_source.h"

#include <utility>

namespace patina::sensor {

const Reading* LookAheadSource::peek(size_t ahead) {
    while (ahead_.size() <= ahead) {
        std::optional<Reading> reading = source_->next();
        if (!reading) return nullptr;
        ahead_.push_back(*std::move(reading));
    }
    return &ahead_[ahead];
}

std::optional<Reading> LookAheadSource::next() {
    if (ahead_.empty()) return source_->next();
    Reading reading = std::move(ahead_.front());
    ahead_.pop_front();
    return reading;
}

}  // namespace patina::sensor
