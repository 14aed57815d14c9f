#pragma once

#include <cstdint>

namespace patina::tools {

inline double mebibytes(uint64_t bytes) { return static_cast<double>(bytes) / (1 << 20); }

}  // namespace patina::tools
