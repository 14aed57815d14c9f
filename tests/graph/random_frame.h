#pragma once

#include <cstdint>

#include "engine/graph/plan/description.h"

namespace patina::graph {

/// A well-wired random frame of up to 24 passes over up to 16 resources: imported and transient, buffers and images, of
/// random sizes and alignments. Same seed, same frame.
Description make_random_frame(uint32_t seed);

}  // namespace patina::graph
