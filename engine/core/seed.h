#pragma once

#include <cstdint>

namespace patina {

/// The seed of one kind of draw: its own one, changed by the seed of the whole run. A run's seed of 0 leaves it; seeds
/// that differ by little, as 1 and 2, give values that have nothing in common (the finaliser of splitmix64, Steele,
/// Lea and Flood 2014).
constexpr uint32_t seed_of_draw(uint32_t own, uint64_t run) {
    run = (run ^ run >> 30) * 0xbf58476d1ce4e5b9u;
    run = (run ^ run >> 27) * 0x94d049bb133111ebu;
    run ^= run >> 31;
    return own ^ static_cast<uint32_t>(run) ^ static_cast<uint32_t>(run >> 32);
}

}  // namespace patina
