#pragma once

#include <cstddef>
#include <cstdint>
#include <set>
#include <span>

#include <glm/glm.hpp>

#include "shared/reflectance/occupancy.h"

namespace patina {

/// What a gpu::Occupancy says: numbers of its bits that are set.
struct OccupancyBits {
    std::set<uint32_t> cubes, cells;

    OccupancyBits() = default;
    explicit OccupancyBits(std::span<const uint32_t> words) {
        for (uint32_t bit = 0; bit < 32 * words.size(); ++bit) {
            if ((words[bit / 32] >> bit % 32 & 1) == 0) continue;
            constexpr uint32_t kFirstOfCells = 32 * gpu::kOccupancyCubeWords;
            if (bit < kFirstOfCells) {
                cubes.insert(bit);
            } else {
                cells.insert(bit - kFirstOfCells);
            }
        }
    }

    /// A cell in use: its cube of 8 cells, and itself within that one, in the order of a curve through cubes of 2
    /// and 4.
    void add(glm::ivec3 cell) {
        uint32_t of_cube = 0, cube_of_cell = 0, within = 0, weight = 1, repeated = 1;
        for (int axis = 0; axis < 3; ++axis) {
            const int cube = (cell[axis] - modulo(cell[axis], 8)) / 8;
            of_cube += weight * static_cast<uint32_t>(modulo(cube, 128));
            cube_of_cell += repeated * static_cast<uint32_t>(modulo(cube, 32));
            weight *= 128;
            repeated *= 32;
            for (int digit = 0; digit < 3; ++digit)
                within += static_cast<uint32_t>(modulo(cell[axis], 8) >> digit & 1) << (3 * digit + axis);
        }
        cubes.insert(of_cube);
        cells.insert(512 * cube_of_cell + within);
    }

  private:
    static int modulo(int value, int by) { return (value % by + by) % by; }
};

}  // namespace patina
