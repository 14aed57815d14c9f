#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>

namespace patina {

/// What a setting allows a pool to grow to, where 0 stands for no limit.
inline uint32_t limit_or_none(uint32_t limit) { return limit > 0 ? limit : UINT32_MAX; }

/// Slots of the hash table of a pool of blocks. At most a quarter of them is taken while the pool is not full: probes
/// stay within one or two buckets. A small pool's table still takes all keys of a frame: which of them get a block is a
/// matter of the keys, but which would find room in a full table is one of who comes first.
inline uint32_t table_slots_for(uint32_t blocks) { return std::bit_ceil(std::max(blocks, 32768u)) * 4; }

}  // namespace patina
