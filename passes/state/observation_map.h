#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "engine/graph/frame_graph.h"
#include "engine/graph/state_visitor.h"
#include "engine/vulkan/device.h"
#include "passes/state/voxel_map.h"
#include "shared/observation/observations.h"

namespace patina {

/// Size and resolution of the observations.
struct ObservationMapSettings {
    float voxel_m = 0.02f;                         ///< half or a quarter of block_m: blocks of 2^3 or 4^3 voxels
    float block_m = 0.04f;                         ///< the voxel map's, so that both have the same keys
    uint32_t capacity_blocks = 65536;              ///< at first; each takes 32 or 256 bytes for its table
    uint32_t capacity_records = 262144;            ///< at first, voxels with observations, kRecordBytes each
    uint32_t limit_blocks = 0;                     ///< beyond which the pool does not grow; 0: as memory allows
    uint32_t limit_records = 0;                    ///< likewise
    uint64_t max_chunk_bytes = uint64_t{1} << 27;  ///< of one buffer
};

/// Versions of the map's resources within one frame; passes that write replace the ids.
struct ObservationMapIds {
    graph::BufferId keys;             ///< u32 per table slot: a block's packed coordinates, kEmptyKey when unused
    graph::BufferId blocks;           ///< u32 per table slot: block id, kNoBlock for a refused key
    graph::BufferId block_keys;       ///< u32 per block: its key, kEmptyKey when the block is free
    graph::BufferId free_blocks;      ///< u32 stack of free block ids, as many as block_counters.free_blocks
    graph::BufferId free_records;     ///< u32 stack of free record ids, as many as record_counters.free_blocks
    graph::BufferId new_slots;        ///< u32 list of the slots inserted in this frame
    graph::BufferId block_counters;   ///< gpu::MapCounters of the blocks
    graph::BufferId record_counters;  ///< gpu::MapCounters of the records
    graph::BufferId block_arguments;  ///< dispatch over all block ids in use, 64 a group
    graph::BufferId record_table;     ///< u32 per voxel of each block: record id, or kNoRecord, kRefusedRecord
    graph::BufferId records;          ///< gpu::VoxelRecord per record; of one that was given back: kEmptyKey
    graph::BufferId seen;             ///< u32 per record: the frame that saw it last, index + 1
    graph::BufferId changed;          ///< u32 per record: the frame that changed it last, index + 1; 0: never
    graph::BufferId albedo;           ///< uvec2 per record, zero at first: for the refinement's kd and its weight
    graph::BufferId visibility;       ///< uvec2 per record, zero at first: a bit per light that reaches it
    graph::BufferId directions;       ///< kRecordQuads uvec4 per record, chunked: lib/records/record_directions.glsl
    graph::BufferId colors;           ///< kRecordQuads uvec4 per record, chunked: lib/records/record_colors.glsl
};

/// Reflectance observations by voxel (paper, Section 3.4): a hash table of blocks with the voxel map's keys, each with
/// a table of its voxels, and a pool of records, of which a voxel takes one when it is first observed: a surface
/// crosses few of a block's voxels. Lives as long as the reconstruction; passes/observation fills it. Which voxels have
/// records, and what these hold, does not depend on the order in which GPU invocations ran, though ids do. What is full
/// refuses by key, counts that, and keeps what it has. Records whose surface went are given back
/// (observation/reclaim_records.h).
///
/// Memory of a record: 30 observations of 8 bytes with 16 bytes of their closest pair; 16 bytes of position, surface
/// and label; 8 of stamps, 8 of albedo, 8 of visibility, 4 of the list of free ones. With its entry in the tables a
/// voxel of 2 cm takes about 300 bytes: a square metre of surface about 1.1 MB, at 1 cm 4.5 MB.
class ObservationMap {
  public:
    static constexpr uint32_t kRecordBytes = 2 * gpu::kRecordQuads * 16 + sizeof(gpu::VoxelRecord) + 3 * 4 + 2 * 8;

    /// Throws Error when a size makes no sense, a capacity exceeds what the buffers hold, or memory runs out.
    ObservationMap(vulkan::Device& device, const ObservationMapSettings& settings);

    /// Empties the map, placing the range of keys around a world point (metres), the voxel map's; the first thing done
    /// with it.
    void reset(graph::FrameGraph& frame, glm::dvec3 center_m);

    /// Announce that a pool grows, to more than now and at most most_blocks() or most_records(). In the same frame
    /// observation/grow_observations.h makes use of it.
    void enlarge_blocks(graph::Enlargement& enlargement, uint32_t blocks);
    void enlarge_records(graph::Enlargement& enlargement, uint32_t records);

    ObservationMapIds import(graph::FrameGraph& frame) const;
    /// Marks all versions as needed after the frame.
    static void keep(graph::FrameGraph& frame, const ObservationMapIds& ids);

    void visit(graph::StateVisitor& visitor);

    const ObservationMapSettings& settings() const { return settings_; }
    /// Of voxels; its chunk_shift is that of records.
    gpu::VoxelGrid grid() const { return grid_; }
    /// A block has 1 << edge_shift() voxels along each edge.
    uint32_t edge_shift() const { return edge_shift_; }
    uint32_t capacity_blocks() const { return grid_.capacity; }  ///< at present
    uint32_t capacity_records() const { return capacity_records_; }
    uint32_t most_blocks() const { return most_blocks_; }  ///< that the pools can grow to, memory permitting
    uint32_t most_records() const { return most_records_; }
    uint32_t chunk_records() const { return 1u << grid_.chunk_shift; }
    uint32_t table_slots() const { return table_slots_; }
    uint32_t chunks() const { return static_cast<uint32_t>(directions_.chunks().size()); }
    std::vector<VoxelMap::PoolBytes> memory() const;

  private:
    ObservationMapSettings settings_;
    gpu::VoxelGrid grid_{};
    uint32_t edge_shift_ = 0;
    uint32_t table_slots_ = 0;
    uint32_t capacity_records_ = 0, most_blocks_ = 0, most_records_ = 0;
    vulkan::BufferRef keys_, blocks_, block_keys_, free_blocks_, free_records_, new_slots_, block_counters_,
        record_counters_, block_arguments_, record_table_, records_, seen_, changed_, albedo_, visibility_;
    vulkan::ChunkedBuffer directions_, colors_;
};

}  // namespace patina
