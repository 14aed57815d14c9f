#pragma once

#include <string>
#include <vector>

#include "reconstruction/pipeline.h"
#include "tools/bench/distribution.h"
#include "tools/bench/recording.h"

namespace patina::bench {

/// GPU times of one pass.
struct PassTimes {
    std::string name;
    Distribution ms;
};

/// What one run over a recording took. Per-frame figures leave out the warm-up.
struct Measurement {
    vulkan::DeviceCaps caps;
    uint32_t frames = 0;
    std::vector<PassTimes> passes;   ///< in order of first appearance
    float geometry_ms = 0;           ///< sum of the medians of the dispatches that every frame has
    float transfers_ms = 0;          ///< the same for uploads, fills, copies and read-backs
    uint32_t dispatches = 0;         ///< of the frame that had most
    uint32_t frame_passes = 0;       ///< of that frame, transfers included
    uint32_t late_compilations = 0;  ///< frame shapes that were new after the warm-up
    Distribution integrate_ms, integrate_mvoxel_s, allocate_ms, raycast_ms;
    float visible_mvoxel = 0;    ///< median over the frames
    Distribution submit_ms;      ///< host: compile or look up, record, submit
    Distribution add_ms;         ///< host: all of Pipeline::add, with declaring the frame and staging its pictures
    float allocated_mvoxel = 0;  ///< at the end
    uint32_t refused_blocks = 0;
    std::vector<PassTimes> surface_passes;  ///< times of one extraction, summed by pass
    Distribution surface_ms;                ///< GPU
    Distribution surface_wall_ms;           ///< host, with read-backs and the making of the mesh
    size_t triangles = 0;
    float first_frame_s = 0;  ///< from before the device is opened until the first frame is fused
    std::vector<VoxelMap::PoolBytes> pools;
    uint64_t transient_bytes = 0;
    uint64_t recording_bytes = 0;
    uint64_t peak_resident_bytes =
        0;  ///< of the process, with the recording, and with device memory on software devices
};

/// Reconstructs the recording frame by frame, each one alone on the device, and then extracts the surface. Throws Error
/// where the device has no timestamps.
Measurement measure(const Recording& recording, uint32_t warmup, const ReconstructionSettings& settings,
                    const vulkan::DeviceOptions& options);

}  // namespace patina::bench
