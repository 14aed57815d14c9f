#include "tests/reference/segmentation/segment_table.h"

namespace patina::reference {

namespace {

struct Ranked {
    uint32_t label = 0, pixels = 0;
};

/// The labels that a segment shares most pixels with, the smaller first of equal ones.
std::pair<Ranked, Ranked> two_best(const SeenSegment& segment) {
    Ranked best, second;
    for (const auto& [label, pixels] : segment.shared) {
        if (pixels > best.pixels) {
            second = best;
            best = {label, pixels};
        } else if (pixels > second.pixels) {
            second = {label, pixels};
        }
    }
    return {best, second};
}

}  // namespace

SegmentBook::SegmentBook(const Rules& rules) : rules_(rules) {
    for (uint32_t label = 1; label < rules.capacity; ++label) free_.push_back(label);
}

uint32_t SegmentBook::root(uint32_t label) const {
    for (auto it = merged_into_.find(label); it != merged_into_.end(); it = merged_into_.find(label))
        label = it->second;
    return live(label) ? label : 0;
}

namespace {

/// Whether the map knows more than half of a segment.
bool mostly_known(const SeenSegment& segment) {
    uint32_t known = 0;
    for (const auto& [label, pixels] : segment.shared) known += pixels;
    return 2 * known > segment.pixels;
}

}  // namespace

bool SegmentBook::inherits(const SeenSegment& segment) const {
    const uint32_t best = two_best(segment).first.pixels;
    return best >= rules_.inherit_pixels && (best > rules_.inherit_share * segment.pixels || mostly_known(segment));
}

std::vector<uint32_t> SegmentBook::assign(const std::vector<SeenSegment>& segments) {
    counted_.clear();
    std::vector<uint32_t> labels;
    for (const SeenSegment& segment : segments) {
        const Ranked best = two_best(segment).first;
        const bool known = inherits(segment);
        labels.push_back(known ? best.label : 0);
        if (known) live_[best.label].seen = now_;
    }
    for (size_t i = 0; i < segments.size(); ++i) {
        if (labels[i] != 0 || mostly_known(segments[i])) continue;
        if (segments[i].pixels < rules_.new_pixels || free_.empty()) continue;
        labels[i] = free_.front();
        free_.pop_front();
        live_[labels[i]] = {now_, now_};
    }
    return labels;
}

std::vector<std::pair<uint32_t, uint32_t>> SegmentBook::joined(const std::vector<SeenSegment>& segments) const {
    std::vector<std::pair<uint32_t, uint32_t>> pairs;
    for (const SeenSegment& segment : segments) {
        const auto [best, second] = two_best(segment);
        if (!inherits(segment) || second.pixels < rules_.inherit_pixels) continue;
        if (second.pixels <= rules_.merge_share * segment.pixels) continue;
        pairs.emplace_back(best.label, second.label);
    }
    return pairs;
}

void SegmentBook::merge(uint32_t into, uint32_t label) {
    live_[into].since = std::min(live_[into].since, live_[label].since);
    live_.erase(label);
    ++merged_;
    retired_[label] = now_;
    merged_into_[label] = into;
}

void SegmentBook::discount() {
    for (auto it = pairs_.begin(); it != pairs_.end();) {
        auto& [pair, count] = *it;
        const bool both = live(pair.first) && live(pair.second);
        if (both && !counted_.contains(pair) && live_[pair.first].seen == now_ && live_[pair.second].seen == now_)
            --count;
        it = !both || count == 0 ? pairs_.erase(it) : std::next(it);
    }
}

void SegmentBook::end_sweep(const std::map<uint32_t, uint32_t>& voxels) {
    for (auto it = retired_.begin(); it != retired_.end();) {
        if (now_ - it->second <= rules_.sweep_frames) {
            ++it;
            continue;
        }
        free_.push_back(it->first);
        merged_into_.erase(it->first);
        it = retired_.erase(it);
    }
    for (auto it = live_.begin(); it != live_.end();) {
        const auto& [label, age] = *it;
        const auto found = voxels.find(label);
        const bool lost = now_ - age.since > rules_.sweep_frames && now_ - age.seen > rules_.prune_frames &&
                          (found == voxels.end() ? 0 : found->second) < rules_.prune_voxels;
        if (lost) retired_[label] = now_;
        pruned_ += lost ? 1 : 0;
        it = lost ? live_.erase(it) : std::next(it);
    }
}

}  // namespace patina::reference
