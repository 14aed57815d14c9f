#include "sensor/live/waiting_skips.h"

#include <utility>

#include "engine/core/error.h"

namespace patina::sensor {

void WaitingSkips::push(Skipped skipped) {
    if (beyond_.count() == 0) {
        const bool follows = !entries_.empty() && skipped.dropped && entries_.back().first.dropped &&
                             skipped.index == entries_.back().first.index + entries_.back().count;
        if (follows) {
            ++entries_.back().count;
            return;
        }
        if (entries_.size() < kMostEntries) {
            entries_.push_back({std::move(skipped)});
            return;
        }
        beyond_.first = beyond_.next = skipped.index;
    }
    beyond_.last = skipped.index;
    ++(skipped.dropped ? beyond_.dropped : beyond_.damaged);
    if (skipped.dropped) beyond_.dropped_for = std::move(skipped.reason);
}

std::optional<Skipped> WaitingSkips::pop() {
    if (empty()) return std::nullopt;
    if (entries_.empty()) return pop_beyond();
    Entry& oldest = entries_.front();
    Skipped skipped = oldest.first;
    if (--oldest.count == 0) {
        entries_.pop_front();
    } else {
        ++oldest.first.index;
    }
    return skipped;
}

/// The damaged ones come first.
Skipped WaitingSkips::pop_beyond() {
    const uint32_t index = beyond_.next++;
    if (beyond_.damaged > 0) {
        --beyond_.damaged;
        return {index, text("damaged, as others of the frames ", beyond_.first, " to ", beyond_.last,
                            " were: too many waited to keep each one's reason")};
    }
    --beyond_.dropped;
    return {index, beyond_.dropped_for, true};
}

}  // namespace patina::sensor
