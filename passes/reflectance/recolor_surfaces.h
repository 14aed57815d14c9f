#pragma once

#include "passes/reflectance/find_due_records.h"

namespace patina {

/// What surfaces send under lights that no frame showed.
struct RecolorInputs {
    RecordList listed;         ///< whose voxels get another colour
    graph::BufferId segments;  ///< gpu::SegmentAlbedo[params.materials] (add_average_segments)
    bool gathers = false;      ///< what records gathered arrives; else the ambient term does
};

/// Gives the voxels of the listed records the colour that their surface has under the present lights, linear radiance:
/// kd times what arrives of the lamps (find_visibility.h) and from all around, and observed ks times the latter. Lamps'
/// highlights, which one viewer sees and another does not, are left out. So light that is gathered after that is light
/// of the present lamps that surfaces send on. Where no kd is known there is none. `frame_voxels.color` is replaced.
void add_recolor_surfaces(graph::FrameGraph& frame, const ReflectanceFrame& reflectance, VoxelMapIds& frame_voxels,
                          const RecolorInputs& inputs);

}  // namespace patina
