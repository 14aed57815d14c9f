#include "sensor/ledger.h"

#include <algorithm>

#include "engine/core/error.h"

namespace patina::sensor {

void Ledger::note(const Reading& reading) {
    ++read_;
    const auto* skipped = std::get_if<Skipped>(&reading);
    if (!skipped) return;
    if (!skipped->dropped) return skip(skipped->index, skipped->reason);
    ++dropped_;
    settle(skipped->index);
}

void Ledger::use(uint32_t index) {
    ++used_;
    settle(index);
}

void Ledger::skip(uint32_t index, std::string reason) {
    skipped_.push_back({index, std::move(reason)});
    settle(index);
}

void Ledger::repeat(uint32_t index) {
    ++repeated_;
    settle(index);
}

void Ledger::undo(uint32_t count) {
    PATINA_ASSERT(count <= used_, count, " of ", used_, " frames");
    used_ -= count;
    undone_ += count;
}

void Ledger::settle(uint32_t index) {
    if (index >= settled_.size()) settled_.resize(size_t{index} + 1);
    ++settled_[index];
}

std::optional<std::string> Ledger::discrepancy(const SequenceInfo& info) const {
    if (const uint32_t frames = info.frames.value_or(read_); read_ != frames) {
        return text(info.name, " has ", frames, " frames, but ", read_,
                    " were read: ", read_ < frames ? frames - read_ : read_ - frames,
                    read_ < frames ? " missing" : " too many");
    }
    const size_t left_out = repeated_ + dropped_ + skipped_.size(), settled = used_ + undone_ + left_out;
    if (settled != read_) {
        return text(info.name, ": ", read_, " frames were read, but ", used_ + undone_, " used and ", left_out,
                    " left out: ", settled < read_ ? read_ - settled : settled - read_,
                    settled < read_ ? " unaccounted for" : " too many");
    }
    const auto repeated = std::find_if(settled_.begin(), settled_.end(), [](uint32_t count) { return count > 1; });
    if (repeated == settled_.end()) return std::nullopt;
    return text(info.name, ": frame ", repeated - settled_.begin(), " was used or skipped ", *repeated,
                " times instead of once");
}

}  // namespace patina::sensor
