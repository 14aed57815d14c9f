#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "engine/graph/enlargement.h"
#include "engine/graph/frame_graph.h"
#include "engine/graph/state_visitor.h"
#include "engine/vulkan/device.h"
#include "shared/fusion/voxel_map.h"

namespace patina {

/// Size and resolution of the volume.
struct VoxelMapSettings {
    float voxel_m = 0.005f;
    uint32_t capacity_blocks = 32768;  ///< at first, of 8^3 voxels; each takes 2 KiB of distances and 2 KiB of colour
    uint64_t max_chunk_bytes = uint64_t{1} << 30;  ///< of one buffer; above, devices differ in what they can allocate
    uint32_t limit_blocks = 0;  ///< beyond which the pool does not grow; 0: as far as chunks and memory allow
};

/// Versions of the map's resources within one frame; passes that write replace the ids.
struct VoxelMapIds {
    graph::BufferId keys;    ///< u32 per table slot: a block's packed coordinates, kEmptyKey when unused
    graph::BufferId blocks;  ///< u32 per table slot: block id, kNoBlock for a refused key; undefined for unused slots
    graph::BufferId block_keys;        ///< u32 per block: its key, kEmptyKey when the block is free
    graph::BufferId free_list;         ///< u32 stack of free block ids, MapCounters::free_blocks of them
    graph::BufferId new_slots;         ///< u32 list of the slots inserted in this frame
    graph::BufferId counters;          ///< gpu::MapCounters
    graph::BufferId assign_arguments;  ///< dispatch over the new slots
    graph::BufferId block_arguments;   ///< dispatch over all block ids below the high-water mark, 64 a group
    graph::BufferId tsdf;  ///< u32 per voxel, chunked: snorm16 distance in units of kSdfRangeVox voxels | u16 weight
    graph::BufferId
        color;  ///< u32 per voxel, chunked: 11 + 11 + 10 bits of root-encoded linear colour; 0 where none was seen
};

/// The sparse TSDF volume: a hash table of 32-bit block keys in buckets of four, and a pool of blocks of 8^3 voxels
/// with their colours in an array of its own, both spread over buffers that every device can bind. Lives as long as the
/// reconstruction; passes/fusion fills it. Content that matters does not depend on the order in which GPU invocations
/// ran, though block ids do.
class VoxelMap {
  public:
    /// Throws Error when the capacity is zero, exceeds what the chunks hold, or memory runs out. The pool begins with
    /// the smaller of capacity and limit.
    VoxelMap(vulkan::Device& device, const VoxelMapSettings& settings);

    /// Empties the map, placing the range of keys around a world point (metres); the first thing done with it.
    void reset(graph::FrameGraph& frame, glm::dvec3 center_m);

    /// Announces that the pool grows to `blocks`, more than now and at most most_blocks(). After the commit new blocks
    /// are neither free nor is the table filled: fusion/grow_voxels.h does that in the same frame.
    void enlarge(graph::Enlargement& enlargement, uint32_t blocks);

    VoxelMapIds import(graph::FrameGraph& frame) const;
    /// Marks all versions as needed after the frame.
    static void keep(graph::FrameGraph& frame, const VoxelMapIds& ids);

    void visit(graph::StateVisitor& visitor);

    const VoxelMapSettings& settings() const { return settings_; }
    gpu::VoxelGrid grid() const { return grid_; }
    uint32_t capacity() const { return grid_.capacity; }   ///< blocks, at present
    uint32_t most_blocks() const { return most_blocks_; }  ///< that the pool can grow to, memory permitting
    /// Blocks of one chunk: an array of up to as many is one buffer.
    uint32_t chunk_blocks() const { return 1u << grid_.chunk_shift; }
    uint32_t table_slots() const { return table_slots_; }
    uint32_t chunks() const { return static_cast<uint32_t>(tsdf_.chunks().size()); }

    /// Device memory by pool, in bytes.
    struct PoolBytes {
        const char* name;
        uint64_t bytes;
    };
    std::vector<PoolBytes> memory() const;

  private:
    VoxelMapSettings settings_;
    gpu::VoxelGrid grid_{};
    uint32_t table_slots_ = 0;
    uint32_t most_blocks_ = 0;
    vulkan::BufferRef keys_, blocks_, block_keys_, free_list_, new_slots_, counters_, assign_arguments_,
        block_arguments_;
    vulkan::ChunkedBuffer tsdf_, color_;
};

}  // namespace patina
