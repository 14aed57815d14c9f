#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

namespace patina::reference {

/// An observation as far as its set is concerned: where it was seen from, and which one it is.
struct Direction {
    glm::ivec3 on_grid{0};  ///< the unit vector in steps of 1/2048
    uint32_t id = 0;
};

/// The direction that a word of a record stands for: octahedral coordinates of 13 bits each.
glm::dvec3 unpack_direction(uint32_t word);
/// The same as compared; `clear` is false where that is within a thousandth of a step of rounding otherwise.
glm::ivec3 on_grid(glm::dvec3 direction, bool* clear = nullptr);

/// The paper's rule (Section 3.4): adds an observation to a set of at most `most`. One within sqrt(merge_distance2) of
/// another is left out. When there is one too many, one of the closest pair goes: the new one if it belongs to that,
/// else the one whose next nearest neighbour is nearer, whose place the new one takes. Of equals, the pair whose later
/// member comes first, then the earlier member, counts as the closest, and the later member goes.
void insert(std::vector<Direction>& set, const Direction& added, size_t most, double merge_distance2);

/// Farthest-point sampling: `most` of the directions, each the one farthest from those before; starts with the first.
std::vector<Direction> farthest_points(const std::vector<Direction>& all, size_t most);

/// Angles (radians) from each of `all` to the nearest of `kept`.
struct Coverage {
    double mean = 0;
    double largest = 0;
};
Coverage coverage(const std::vector<Direction>& all, const std::vector<Direction>& kept);

}  // namespace patina::reference
