#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

namespace patina::reference {

/// A segment of one frame, with the pixels it shares with labels of the map.
struct SeenSegment {
    uint32_t pixels = 0;
    std::map<uint32_t, uint32_t> shared;  ///< pixels by label
};

/// The rules by which segments of frames get labels, written as the text says them: no tables of fixed size.
class SegmentBook {
  public:
    struct Rules {
        uint32_t capacity = 64;
        double inherit_share = 0.3, merge_share = 0.2;
        uint32_t inherit_pixels = 15, new_pixels = 100, merge_count = 3;
        uint32_t sweep_frames = 64, prune_voxels = 10, prune_frames = 30;
    };
    explicit SegmentBook(const Rules& rules);

    /// One frame: the label of each segment, 0 for none. `alike` says which labels may be merged, `seen` how much was
    /// seen of each; `voxels` how many voxels each label was found to have when a sweep ends.
    template <class Alike>
    std::vector<uint32_t> frame(const std::vector<SeenSegment>& segments, Alike&& alike,
                                std::map<uint32_t, uint32_t> seen, const std::map<uint32_t, uint32_t>& voxels) {
        ++now_;
        std::vector<uint32_t> labels = assign(segments);
        for (const auto& [best, second] : joined(segments)) {
            const std::pair pair = std::minmax(best, second);
            if (!live(best) || !live(second) || counted_.contains(pair)) continue;
            counted_.insert(pair);
            if (++pairs_[pair] < rules_.merge_count || !alike(best, second)) continue;
            const auto [low, high] = pair;
            const bool low_remains = seen[low] >= seen[high];
            merge(low_remains ? low : high, low_remains ? high : low);
            seen[low] = seen[high] = seen[low] + seen[high];
        }
        discount();
        for (uint32_t& label : labels) label = root(label);
        if (now_ % rules_.sweep_frames == 0) end_sweep(voxels);
        return labels;
    }

    bool live(uint32_t label) const { return live_.contains(label); }
    size_t live_labels() const { return live_.size(); }
    uint32_t merged() const { return merged_; }
    uint32_t pruned() const { return pruned_; }
    uint32_t root(uint32_t label) const;

  private:
    struct Age {
        uint32_t since = 0, seen = 0;
    };
    std::vector<uint32_t> assign(const std::vector<SeenSegment>& segments);
    std::vector<std::pair<uint32_t, uint32_t>> joined(const std::vector<SeenSegment>& segments) const;
    void merge(uint32_t into, uint32_t label);
    bool inherits(const SeenSegment& segment) const;
    void discount();
    void end_sweep(const std::map<uint32_t, uint32_t>& voxels);

    Rules rules_;
    uint32_t now_ = 0, merged_ = 0, pruned_ = 0;
    std::deque<uint32_t> free_;
    std::map<uint32_t, Age> live_;
    std::map<uint32_t, uint32_t> retired_;  ///< since when
    std::map<uint32_t, uint32_t> merged_into_;
    std::map<std::pair<uint32_t, uint32_t>, uint32_t> pairs_;
    std::set<std::pair<uint32_t, uint32_t>> counted_;  ///< in this frame
};

}  // namespace patina::reference
