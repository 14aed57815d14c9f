#pragma once

#include <map>
#include <optional>
#include <vector>

#include "passes/observation/observation.h"
#include "passes/state/reflectance_state.h"
#include "reconstruction/streaming/stream_region.h"
#include "shared/fusion/remove_empty_blocks.h"
#include "tests/gpu/fusion/fusion_rig.h"

namespace patina {

/// A voxel's record as stored.
struct RecordContent {
    gpu::VoxelRecord record{};
    std::vector<uint32_t> directions, colors;  ///< one word per observation
    uint32_t changed = 0;

    uint32_t count() const { return record.state & 31; }
    bool operator==(const RecordContent& other) const;
};
/// By the voxel's coordinates: voxel v spans [v, v + 1) times its size from the world's origin.
using ObservationContent = std::map<std::array<int, 3>, RecordContent>;

/// One RGB-D frame of a pinhole camera.
struct RigFrame {
    Intrinsics camera;
    RigidTransform world_from_camera;
    Image<float> depth_m;
    ColorView color;
    std::optional<Image<uint32_t>> labels{};
    std::optional<CameraMotion> motion{};
};

/// A voxel map, an observation map and the passes that fill them, for tests.
class ObservationRig {
  public:
    ObservationRig(vulkan::Device& device, graph::Runner& runner, const ObservationMapSettings& map = {},
                   const ObservationSettings& settings = {}, const FusionSettings& fusion = {},
                   const VoxelMapSettings& voxels = {});

    /// Fuses the frame's depth; `times` so that every block is allocated.
    void fuse(const RigFrame& frame, int times = 4);

    struct Collected {
        uint32_t visible = 0, changed = 0;    ///< records
        Image<glm::vec4> position_m, normal;  ///< the model as it was cast
    };
    /// Casts the model into the frame's camera and collects its observations.
    Collected collect(const RigFrame& frame);

    /// Gives back what holds no surface any more of the part of the observations whose turn it is.
    /// Near the surface is what is within `near` truncations of it.
    void reclaim(uint32_t turn, float near = gpu::kSurfaceTruncation, const StreamRegion& region = {});

    ObservationContent content();
    /// A pool's ids in use, and the valid part of its list of free ones.
    struct PoolIds {
        std::vector<uint32_t> used, free;
    };
    PoolIds block_ids();
    PoolIds record_ids();
    /// The records that shaders find for these voxels (w unused); block_key is kEmptyKey where there is none.
    std::vector<gpu::VoxelRecord> find(const std::vector<glm::ivec4>& voxels);
    gpu::MapCounters block_counters();
    gpu::MapCounters record_counters();

    ObservationMap& map() { return map_; }
    FusionRig& fusion() { return fusion_; }
    const ObservationSettings& settings() const { return settings_; }

  private:
    PoolIds pool_ids(graph::BufferId ObservationMapIds::*free_list, const gpu::MapCounters& counters);
    gpu::MapCounters read(graph::BufferId ObservationMapIds::*counters);

    graph::Runner& runner_;
    FusionRig fusion_;
    ObservationMap map_;
    ReflectanceState state_;
    ObservationSettings settings_;
    uint32_t frame_ = 0;
};

}  // namespace patina
