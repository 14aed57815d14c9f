#include "sensor/associate.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numeric>
#include <queue>
#include <tuple>

namespace patina::sensor {
namespace {

constexpr size_t kNone = SIZE_MAX;

/// The elements of one list that share a timestamp and have no partner yet, in the order of their indices.
struct Group {
    double time_s = 0;
    bool of_a = false;
    std::vector<size_t> indices{};
    size_t paired = 0;  ///< of the indices, from the first on
    size_t before = kNone, after = kNone;

    bool empty() const { return paired == indices.size(); }
    size_t first() const { return indices[paired]; }
};

/// The elements of a list, by time and then by index.
std::vector<size_t> by_time(std::span<const double> times_s) {
    std::vector<size_t> order(times_s.size());
    std::iota(order.begin(), order.end(), size_t{0});
    std::sort(order.begin(), order.end(),
              [&](size_t i, size_t j) { return std::tie(times_s[i], i) < std::tie(times_s[j], j); });
    return order;
}

/// Of all elements without a partner the nearest two are neighbours in time: what lay between them would be nearer to
/// one of them. So a queue of neighbours' distances yields all pairs in the rule's order, once elements of the same
/// time are paired.
class Association {
  public:
    Association(std::span<const double> a, std::span<const double> b, double limit_s)
        : limit_s_(limit_s), partner_(a.size()) {
        gather(a, b);
        for (size_t g = 0; g < groups_.size(); ++g) {
            groups_[g].before = g == 0 ? kNone : g - 1;
            groups_[g].after = g + 1 == groups_.size() ? kNone : g + 1;
            consider(groups_[g].before, g);
        }
    }

    std::vector<std::optional<size_t>> partners() && {
        while (!queue_.empty()) {
            const Candidate nearest = queue_.top();
            queue_.pop();
            if (holds(nearest)) pair(nearest);
        }
        return std::move(partner_);
    }

  private:
    /// The first elements of two neighbouring groups.
    struct Candidate {
        double distance_s;
        size_t i, j;  ///< in a and b
        size_t group_a, group_b;

        bool operator>(const Candidate& other) const {
            return std::tie(distance_s, i, j) > std::tie(other.distance_s, other.i, other.j);
        }
    };

    /// Makes the groups, in order of time; elements of both lists at the same time are paired at once.
    void gather(std::span<const double> a, std::span<const double> b) {
        const std::vector<size_t> order_a = by_time(a), order_b = by_time(b);
        auto i = order_a.begin();
        auto j = order_b.begin();
        while (i != order_a.end() || j != order_b.end()) {
            const double time_s = j == order_b.end() || (i != order_a.end() && a[*i] < b[*j]) ? a[*i] : b[*j];
            Group in_a{time_s, true}, in_b{time_s, false};
            for (; i != order_a.end() && a[*i] == time_s; ++i) in_a.indices.push_back(*i);
            for (; j != order_b.end() && b[*j] == time_s; ++j) in_b.indices.push_back(*j);
            while (!in_a.empty() && !in_b.empty()) partner_[in_a.indices[in_a.paired++]] = in_b.indices[in_b.paired++];
            for (Group* group : {&in_a, &in_b}) {
                if (!group->empty()) groups_.push_back(std::move(*group));
            }
        }
    }

    /// Queues two neighbours where they may be paired.
    void consider(size_t earlier, size_t later) {
        if (earlier == kNone || later == kNone || groups_[earlier].of_a == groups_[later].of_a) return;
        const size_t group_a = groups_[earlier].of_a ? earlier : later, group_b = earlier + later - group_a;
        const double a_s = groups_[group_a].time_s, b_s = groups_[group_b].time_s;
        if (b_s < a_s - limit_s_ || b_s > a_s + limit_s_) return;
        queue_.push({std::abs(b_s - a_s), groups_[group_a].first(), groups_[group_b].first(), group_a, group_b});
    }

    /// Whether both elements are still without a partner; their groups are neighbours as long as they are.
    bool holds(const Candidate& candidate) const {
        const Group &a = groups_[candidate.group_a], &b = groups_[candidate.group_b];
        return !a.empty() && !b.empty() && a.first() == candidate.i && b.first() == candidate.j;
    }

    void pair(const Candidate& nearest) {
        partner_[nearest.i] = nearest.j;
        for (const size_t group : {nearest.group_a, nearest.group_b}) ++groups_[group].paired;
        for (const size_t group : {nearest.group_a, nearest.group_b}) renew(group);
    }

    /// Queues a group's next element beside its neighbours, or takes an empty group out, which makes them neighbours.
    void renew(size_t group) {
        const auto [before, after] = std::pair(groups_[group].before, groups_[group].after);
        if (!groups_[group].empty()) {
            if (before != kNone && !groups_[before].empty()) consider(before, group);
            if (after != kNone && !groups_[after].empty()) consider(group, after);
            return;
        }
        if (before != kNone) groups_[before].after = after;
        if (after != kNone) groups_[after].before = before;
        if (before != kNone && after != kNone && !groups_[before].empty() && !groups_[after].empty())
            consider(before, after);
    }

    double limit_s_;
    std::vector<std::optional<size_t>> partner_;
    std::vector<Group> groups_;
    std::priority_queue<Candidate, std::vector<Candidate>, std::greater<>> queue_;
};

}  // namespace

std::vector<std::optional<size_t>> associate(std::span<const double> a, std::span<const double> b, double limit_s) {
    return Association(a, b, limit_s).partners();
}

}  // namespace patina::sensor
