#pragma once

#include "engine/graph/frame_graph.h"
#include "passes/state/observation_map.h"
#include "passes/state/reflectance_state.h"
#include "passes/state/voxel_map.h"
#include "shared/fusion/stream_blocks.h"

namespace patina {

/// Gives back what one of gpu::kReclaimParts parts of the observations, `turn` modulo their number, holds of surface
/// that went: things that were moved, noise that was carved away. A record goes when its voxel holds no voxel of
/// `voxels` that was seen within `near_m` metres of the surface; a block goes with its last record. Outside of
/// `region`, where voxels may be away from the device, nothing goes. Then rebuilds the table. Voxels of that part, and
/// all keys, that had been refused get another chance, and count as refused once more where there is still no place for
/// them. Counts in MapCounters::deleted_blocks. Whoever keeps record ids from frame to frame has to choose them anew in
/// the same frame (segmentation/sample_records.h). `status` of records that went is zero, as of new ones.
void add_reclaim_records(graph::FrameGraph& frame, const ObservationMap& map, ObservationMapIds& ids,
                         ReflectanceStateIds& state, const VoxelMap& voxel_map, const VoxelMapIds& voxels, float near_m,
                         const gpu::StreamRegion& region, uint32_t turn);

}  // namespace patina
