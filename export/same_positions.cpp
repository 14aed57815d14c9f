#include "export/same_positions.h"

#include <bit>

namespace patina {

namespace {

constexpr uint32_t kEmpty = UINT32_MAX;

uint64_t hash_of(glm::vec3 position) {
    position += 0.0f;  // -0 equals 0
    uint64_t hash = 0;
    for (glm::length_t axis = 0; axis < 3; ++axis)
        hash = (hash ^ std::bit_cast<uint32_t>(position[axis])) * 0x9e37'79b9'7f4a'7c15u;
    return hash >> 32;
}

}  // namespace

std::vector<uint32_t> first_of_position(std::span<const glm::vec3> positions_m) {
    std::vector<uint32_t> first(positions_m.size()), table(std::bit_ceil(2 * positions_m.size() + 1), kEmpty);
    for (uint32_t vertex = 0; vertex < first.size(); ++vertex) {
        const glm::vec3 position = positions_m[vertex];
        size_t at = hash_of(position) % table.size();
        while (table[at] != kEmpty && positions_m[table[at]] != position) at = (at + 1) % table.size();
        if (table[at] == kEmpty) table[at] = vertex;
        first[vertex] = table[at];
    }
    return first;
}

}  // namespace patina
