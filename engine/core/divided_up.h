#pragma once

#include <cstdint>

namespace patina {

/// How many parts of size `part` it takes to hold `whole`.
constexpr uint32_t divided_up(uint32_t whole, uint32_t part) { return (whole + part - 1) / part; }

}  // namespace patina
