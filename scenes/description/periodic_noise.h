#pragma once

#include <cstdint>

#include <glm/glm.hpp>

namespace patina::scenes {

/// An even hash of a cell and a seed.
uint32_t hash_cell(glm::uvec2 cell, uint32_t seed);

/// That hash as a number in [0, 1).
float random_of_cell(glm::uvec2 cell, uint32_t seed);

/// Value noise in [0, 1) on the unit square, which it tiles: random values on a lattice of `cells`, joined smoothly.
float periodic_noise(glm::vec2 uv, glm::uvec2 cells, uint32_t seed);

/// Octaves of value noise, each of twice the cells and half the amplitude of the one before, up to `finest` cells along
/// the longer side (at least one octave); in [0, 1).
float periodic_octaves(glm::vec2 uv, glm::uvec2 cells, uint32_t finest, uint32_t seed);

}  // namespace patina::scenes
