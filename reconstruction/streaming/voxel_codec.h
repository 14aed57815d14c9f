#pragma once

#include <cstdint>
#include <span>

#include "reconstruction/streaming/block_store.h"
#include "reconstruction/streaming/packer.h"
#include "shared/fusion/stream_blocks.h"

namespace patina {

/// The words of a block's voxels, as they are on the device: gpu::kBlockVoxels each. Without labels `labels` is empty.
template <class Word>
struct VoxelWords {
    std::span<Word> tsdf, color, labels;
};

BlockStore::Kept pack_voxels(Packer& packer, uint32_t label_stamp, const VoxelWords<const uint32_t>& words);

/// Writes the words of block `key`. Throws Error where it is damaged, or the file cannot be read.
void unpack_voxels(Packer& packer, const BlockStore& store, uint32_t key, const VoxelWords<uint32_t>& words);

}  // namespace patina
