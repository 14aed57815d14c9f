#include "scenes/render/bvh.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <optional>

namespace patina::scenes {
namespace {

constexpr uint32_t kBins = 16;
constexpr float kNodeCost = 1.0f;  // of visiting a node, in tests of a primitive
// Below this depth nodes are halved by count, so that no tree is deeper than this plus the logarithm of its leaves.
constexpr uint32_t kMaxSahDepth = 64;

/// Half the surface area, which ratios do not mind.
float area_of(const Bounds& b) {
    if (b.empty()) return 0;
    const glm::vec3 size = b.high - b.low;
    return size.x * size.y + size.y * size.z + size.z * size.x;
}

struct Bin {
    Bounds bounds;
    uint32_t count = 0;
};

struct Split {
    uint32_t axis = 0;
    uint32_t bin = 0;  ///< the first one of the upper child
    float cost = 0;    ///< sum over both children of area times count
};

class Builder {
  public:
    Builder(std::span<const Bounds> boxes, uint32_t max_leaf) : boxes_(boxes), max_leaf_(max_leaf) {
        bvh_.primitives.resize(boxes.size());
        std::iota(bvh_.primitives.begin(), bvh_.primitives.end(), 0u);
        centroids_.reserve(boxes.size());
        for (const Bounds& box : boxes) centroids_.push_back(0.5f * box.low + 0.5f * box.high);
    }

    Bvh build() {
        if (!boxes_.empty()) add_node(0, static_cast<uint32_t>(boxes_.size()), 0);
        return std::move(bvh_);
    }

  private:
    std::span<uint32_t> range(uint32_t begin, uint32_t end) {
        return std::span(bvh_.primitives).subspan(begin, end - begin);
    }

    uint32_t add_node(uint32_t begin, uint32_t end, uint32_t depth) {
        Bounds bounds, centroids;
        for (const uint32_t i : range(begin, end)) bounds.add(boxes_[i]), centroids.add(centroids_[i]);
        const auto index = static_cast<uint32_t>(bvh_.nodes.size());
        bvh_.nodes.push_back({.bounds = bounds, .first = begin, .count = end - begin});
        const std::optional<Split> split =
            depth < kMaxSahDepth ? best_split(begin, end, centroids) : std::optional<Split>();
        const float leaf_cost = static_cast<float>(end - begin) * area_of(bounds);
        const bool worth = split && split->cost + kNodeCost * area_of(bounds) < leaf_cost;
        if (end - begin <= max_leaf_ && !worth) return index;
        const uint32_t axis = split ? split->axis : 0;
        const uint32_t middle = split ? partition(begin, end, *split, centroids) : begin + (end - begin) / 2;
        const uint32_t lower = add_node(begin, middle, depth + 1), upper = add_node(middle, end, depth + 1);
        bvh_.nodes[index] = {.bounds = bounds, .lower = lower, .upper = upper, .axis = axis};
        return index;
    }

    /// Which bin along an axis a primitive falls into.
    uint32_t bin_of(uint32_t primitive, uint32_t axis, const Bounds& centroids) const {
        const int a = static_cast<int>(axis);
        const float share = (centroids_[primitive][a] - centroids.low[a]) / (centroids.high[a] - centroids.low[a]);
        return std::min(static_cast<uint32_t>(share * kBins), kBins - 1);
    }

    /// The cheapest split between two bins; none where all centroids are equal.
    std::optional<Split> best_split(uint32_t begin, uint32_t end, const Bounds& centroids) {
        std::optional<Split> best;
        for (uint32_t axis = 0; axis < 3; ++axis) {
            if (!(centroids.high[static_cast<int>(axis)] > centroids.low[static_cast<int>(axis)])) continue;
            std::array<Bin, kBins> bins;
            for (const uint32_t i : range(begin, end)) {
                Bin& bin = bins[bin_of(i, axis, centroids)];
                bin.bounds.add(boxes_[i]);
                ++bin.count;
            }
            const Split split = best_split_of(bins, axis);
            if (!best || split.cost < best->cost) best = split;
        }
        return best;
    }

    /// The first and the last bin hold something, so that both children of every split do.
    static Split best_split_of(const std::array<Bin, kBins>& bins, uint32_t axis) {
        std::array<float, kBins> upper_cost{};
        Bin upper;
        for (uint32_t b = kBins - 1; b > 0; --b) {
            upper.bounds.add(bins[b].bounds);
            upper.count += bins[b].count;
            upper_cost[b] = area_of(upper.bounds) * static_cast<float>(upper.count);
        }
        Split best{.axis = axis, .bin = 0, .cost = std::numeric_limits<float>::infinity()};
        Bin lower;
        for (uint32_t b = 1; b < kBins; ++b) {
            lower.bounds.add(bins[b - 1].bounds);
            lower.count += bins[b - 1].count;
            const float cost = area_of(lower.bounds) * static_cast<float>(lower.count) + upper_cost[b];
            if (cost < best.cost || best.bin == 0) best = {axis, b, cost};
        }
        return best;
    }

    uint32_t partition(uint32_t begin, uint32_t end, const Split& split, const Bounds& centroids) {
        const auto all = range(begin, end);
        const auto middle = std::stable_partition(
            all.begin(), all.end(), [&](uint32_t i) { return bin_of(i, split.axis, centroids) < split.bin; });
        return begin + static_cast<uint32_t>(middle - all.begin());
    }

    std::span<const Bounds> boxes_;
    uint32_t max_leaf_;
    std::vector<glm::vec3> centroids_;
    Bvh bvh_;
};

void thread(const Bvh& bvh, uint32_t octant, uint32_t index, std::vector<ThreadedNode>& list) {
    const Bvh::Node& node = bvh.nodes[index];
    const size_t at = list.size();
    list.push_back({node.bounds, 0, node.first, node.count});
    if (node.count == 0) {
        const bool upper_first = (octant >> node.axis & 1u) != 0;
        thread(bvh, octant, upper_first ? node.upper : node.lower, list);
        thread(bvh, octant, upper_first ? node.lower : node.upper, list);
    }
    list[at].skip = static_cast<uint32_t>(list.size());
}

}  // namespace

Bvh build_bvh(std::span<const Bounds> boxes, uint32_t max_leaf) { return Builder(boxes, max_leaf).build(); }

std::vector<ThreadedNode> thread_bvh(const Bvh& bvh, uint32_t octant) {
    std::vector<ThreadedNode> list;
    list.reserve(bvh.nodes.size());
    if (!bvh.nodes.empty()) thread(bvh, octant, 0, list);
    return list;
}

}  // namespace patina::scenes
