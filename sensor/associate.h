#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace patina::sensor {

/// Pairs timestamps of two clocks' lists, nearest pairs first, equally near ones by their indices, each element used
/// once, none farther apart than `limit_s`: TUM's rule. Returns for each element of `a` its partner's index in `b`,
/// empty where there is none. Takes n log n steps, however many elements lie within the limit of each other.
std::vector<std::optional<size_t>> associate(std::span<const double> a, std::span<const double> b, double limit_s);

}  // namespace patina::sensor
