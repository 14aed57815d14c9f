#include "tools/viewer/checkpoints.h"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <utility>

#include "engine/store/temporary_database.h"

namespace patina::tools {

bool Checkpoints::due(const RunMoment& moment, double now_s) const {
    if (moment.frames == 0 || now_s < not_before_s_) return false;
    if (states_.empty()) return true;
    const State& last = states_.back();
    return moment.frames > last.moment.frames && moment.frame_s - last.since_s >= kEvery_s;
}

MapFile& Checkpoints::begin() {
    next_.reset();
    if (states_.size() >= kMost) {
        next_ = std::move(states_.front().map);
        states_.pop_front();
    } else {
        next_ = std::make_unique<MapFile>(temporary_database("patina-checkpoint"));
        // A file whose writing failed is given up, so no page's earlier content is needed.
        next_->database().run("PRAGMA journal_mode = OFF");
    }
    return *next_;
}

void Checkpoints::kept(const RunMoment& moment, double now_s, double took_s) {
    const uint64_t bytes = next_->size().compressed_bytes;
    states_.push_back({std::move(next_), moment, moment.frame_s, scanned_s(moment), bytes});
    while (states_.size() > 1 && this->bytes() > kMostBytes) states_.pop_front();
    not_before_s_ = now_s + took_s / kShare;
}

std::optional<size_t> Checkpoints::chosen(const RunMoment& moment) const {
    std::optional<size_t> oldest;
    for (size_t i = states_.size(); i-- > 0;) {
        if (states_[i].moment.frames >= moment.frames) continue;
        if (moment.frame_s - states_[i].since_s >= kYoung_s) return i;
        oldest = i;
    }
    return oldest;
}

MapFile* Checkpoints::choose(const RunMoment& moment) {
    const auto i = chosen(moment);
    return i ? states_[*i].map.get() : nullptr;
}

double Checkpoints::went_back(const RunMoment& moment) {
    const size_t i = chosen(moment).value();
    states_.erase(states_.begin() + static_cast<std::ptrdiff_t>(i) + 1, states_.end());
    State& state = states_.back();
    state.since_s = moment.frame_s;
    const double lost_s = scanned_s(moment) - state.scanned_s;
    lost_s_ += lost_s;
    return lost_s;
}

void Checkpoints::give_up(const RunMoment& moment) {
    states_.erase(states_.begin() + static_cast<std::ptrdiff_t>(chosen(moment).value()));
}

uint64_t Checkpoints::bytes() const {
    return std::accumulate(states_.begin(), states_.end(), uint64_t{0},
                           [](uint64_t sum, const State& state) { return sum + state.bytes; });
}

}  // namespace patina::tools
