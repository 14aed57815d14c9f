#include "scenes/description/periodic_noise.h"

#include <algorithm>

namespace patina::scenes {
namespace {

/// Chris Wellons' integer hash "lowbias32".
uint32_t mix_bits(uint32_t x) {
    x = (x ^ x >> 16) * 0x7feb352dU;
    x = (x ^ x >> 15) * 0x846ca68bU;
    return x ^ x >> 16;
}

}  // namespace

uint32_t hash_cell(glm::uvec2 cell, uint32_t seed) {
    return mix_bits(cell.x + mix_bits(cell.y + mix_bits(seed + 0x9e3779b9U)));
}

float random_of_cell(glm::uvec2 cell, uint32_t seed) {
    return static_cast<float>(hash_cell(cell, seed) >> 8) * 0x1p-24f;  // 24 bits are exact in a float
}

float periodic_noise(glm::vec2 uv, glm::uvec2 cells, uint32_t seed) {
    const glm::vec2 at = glm::fract(uv) * glm::vec2(cells);
    const glm::uvec2 low = glm::uvec2(at) % cells;
    const glm::uvec2 high = (low + 1u) % cells;
    const glm::vec2 t = glm::smoothstep(glm::vec2(0), glm::vec2(1), glm::fract(at));
    const float top = glm::mix(random_of_cell(low, seed), random_of_cell({high.x, low.y}, seed), t.x);
    const float bottom = glm::mix(random_of_cell({low.x, high.y}, seed), random_of_cell(high, seed), t.x);
    return glm::mix(top, bottom, t.y);
}

float periodic_octaves(glm::vec2 uv, glm::uvec2 cells, uint32_t finest, uint32_t seed) {
    float sum = 0, total = 0, amplitude = 1;
    do {
        sum += amplitude * periodic_noise(uv, cells, seed++);
        total += amplitude;
        amplitude /= 2;
        cells *= 2u;
    } while (std::max(cells.x, cells.y) <= finest);
    return sum / total;
}

}  // namespace patina::scenes
