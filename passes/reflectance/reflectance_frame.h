#pragma once

#include "engine/graph/frame_graph.h"
#include "passes/state/map_access.h"
#include "passes/state/observation_map.h"
#include "passes/state/record_list.h"
#include "passes/state/reflectance_state.h"
#include "passes/state/voxel_map.h"
#include "shared/reflectance/reflectance.h"

namespace patina {

/// Through which descriptors the maps are read.
struct ReflectanceAccess {
    MapAccess voxels = MapAccess::kStorage;
    MapAccess observations = MapAccess::kStorage;
};

/// How many records' lights are marched in an update at most, about.
struct MarchBudgets {
    uint32_t first_marched_records;  ///< that never were
    uint32_t marched_records;        ///< whose surface moved since
};

/// What the passes of one update share.
struct ReflectanceFrame {
    const VoxelMap& voxel_map;
    const VoxelMapIds& voxels;
    ReflectanceAccess access;
    const ObservationMap& map;
    ObservationMapIds& records;  ///< visibility and albedo are replaced
    ReflectanceStateIds& state;  ///< replaced
    graph::BufferId lights;      ///< Lights::upload
    graph::BufferId materials;   ///< SegmentMaterials::import
    gpu::ReflectanceParams params;
    MarchBudgets budgets;
    uint32_t gathered_rays;  ///< of each marched record, by which it gathers light; 0: none does
};

}  // namespace patina
