#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "reconstruction/streaming/block_store.h"
#include "reconstruction/streaming/packer.h"
#include "shared/observation/stream_records.h"

namespace patina {

/// Words of a record's directions, and of its colours.
inline constexpr size_t kObservationWords = 4 * size_t{gpu::kRecordQuads};

/// The records of a block as they are on the device, in any order.
struct RecordWords {
    std::span<const gpu::StreamedRecord> records;
    std::span<const uint32_t> directions, colors;  ///< kObservationWords a record
};

/// The same content in any order gives the same bytes; what no observation uses is left out.
BlockStore::Kept pack_records(Packer& packer, const RecordWords& words);

/// How many records were packed.
uint32_t count_records(const BlockStore::Kept& kept);

/// Records of blocks, one after the other.
struct UnpackedRecords {
    std::vector<gpu::StreamedRecord> records;
    std::vector<uint32_t> directions, colors;
};

/// Appends the records of block `key`, with `place` for their block's key. Throws Error where they are damaged, or the
/// file cannot be read.
void unpack_records(Packer& packer, const BlockStore& store, uint32_t key, uint32_t place, UnpackedRecords& to);

}  // namespace patina
