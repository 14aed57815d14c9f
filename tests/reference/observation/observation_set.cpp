#include "tests/reference/observation/observation_set.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace patina::reference {

namespace {

int64_t distance2(const Direction& a, const Direction& b) {
    int64_t sum = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const int64_t d = int64_t{a.on_grid[axis]} - b.on_grid[axis];
        sum += d * d;
    }
    return sum;
}

/// Squared distance from member `of` to its nearest neighbour other than `except`.
int64_t next_nearest(const std::vector<Direction>& set, size_t of, size_t except) {
    int64_t nearest = std::numeric_limits<int64_t>::max();
    for (size_t i = 0; i < set.size(); ++i) {
        if (i != of && i != except) nearest = std::min(nearest, distance2(set[i], set[of]));
    }
    return nearest;
}

/// Signed 13 bits from `shift` on, as a share of one.
double octahedral_coordinate(uint32_t word, uint32_t shift) {
    const int bits = static_cast<int>(word >> shift & 8191);
    return (bits >= 4096 ? bits - 8192 : bits) / 4095.0;
}

double angle(const Direction& a, const Direction& b) {
    return std::acos(
        std::min(glm::dot(glm::normalize(glm::dvec3(a.on_grid)), glm::normalize(glm::dvec3(b.on_grid))), 1.0));
}

}  // namespace

glm::dvec3 unpack_direction(uint32_t word) {
    const double x = octahedral_coordinate(word, 0), y = octahedral_coordinate(word, 13);
    const double z = 1 - std::abs(x) - std::abs(y);
    if (z >= 0) return glm::normalize(glm::dvec3(x, y, z));
    // The lower half's corners are turned outwards.
    return glm::normalize(glm::dvec3(std::copysign(1 - std::abs(y), x), std::copysign(1 - std::abs(x), y), z));
}

glm::ivec3 on_grid(glm::dvec3 direction, bool* clear) {
    const glm::dvec3 steps = direction * 2048.0;
    const glm::dvec3 nearest = glm::round(steps);
    if (clear) {
        const glm::dvec3 off = glm::abs(glm::abs(steps - nearest) - 0.5);
        *clear = std::min({off.x, off.y, off.z}) > 1e-3;
    }
    return glm::ivec3(nearest);
}

void insert(std::vector<Direction>& set, const Direction& added, size_t most, double merge_distance2) {
    for (const Direction& kept : set) {
        if (static_cast<double>(distance2(kept, added)) <= merge_distance2) return;
    }
    set.push_back(added);
    if (set.size() <= most) return;
    size_t first = 0, second = 1;
    for (size_t later = 1; later < set.size(); ++later) {
        for (size_t earlier = 0; earlier < later; ++earlier) {
            if (distance2(set[earlier], set[later]) < distance2(set[first], set[second])) {
                first = earlier;
                second = later;
            }
        }
    }
    const bool first_goes = next_nearest(set, first, second) < next_nearest(set, second, first);
    set.pop_back();
    if (second != most) set[first_goes ? first : second] = added;
}

std::vector<Direction> farthest_points(const std::vector<Direction>& all, size_t most) {
    std::vector<Direction> kept{all.front()};
    while (kept.size() < most) {
        const auto nearest = [&](const Direction& d) {
            int64_t least = std::numeric_limits<int64_t>::max();
            for (const Direction& k : kept) least = std::min(least, distance2(k, d));
            return least;
        };
        kept.push_back(*std::max_element(
            all.begin(), all.end(), [&](const Direction& a, const Direction& b) { return nearest(a) < nearest(b); }));
    }
    return kept;
}

Coverage coverage(const std::vector<Direction>& all, const std::vector<Direction>& kept) {
    Coverage result;
    for (const Direction& d : all) {
        double nearest = std::numeric_limits<double>::max();
        for (const Direction& k : kept) nearest = std::min(nearest, angle(d, k));
        result.mean += nearest / static_cast<double>(all.size());
        result.largest = std::max(result.largest, nearest);
    }
    return result;
}

}  // namespace patina::reference
