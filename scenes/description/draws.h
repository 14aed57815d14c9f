#pragma once

#include <cstdint>
#include <string_view>

#include <glm/glm.hpp>

namespace patina::scenes {

/// Random numbers that are a hash of (seed, subject, index, count of draws): the same with every standard library, and
/// those of one subject do not depend on how many another one took.
class Draws {
  public:
    Draws(uint64_t seed, std::string_view subject, uint64_t index = 0);

    /// Evenly distributed in [low, high).
    double between(double low, double high);
    /// A factor in [1 / most, most), its logarithm evenly distributed.
    double factor(double most);
    /// A whole number in [0, count).
    size_t below(size_t count);
    /// A point in the unit ball.
    glm::dvec3 in_ball();

  private:
    uint64_t next();

    uint64_t key_;
    uint64_t count_ = 0;
};

}  // namespace patina::scenes
