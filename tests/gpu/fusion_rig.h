#pragma once

#include <optional>

#include "engine/graph/runner.h"
#include "passes/fusion/allocate_blocks.h"
#include "passes/fusion/raycast.h"
#include "passes/model/voxel_map.h"
#include "tests/reference/analytic_scene.h"

namespace patina {

/// A map with the passes that fill it, for tests: fuses depth images of analytic scenes and looks at the result.
class FusionRig {
  public:
    FusionRig(vulkan::Device& device, graph::Runner& runner, const VoxelMapSettings& map = {},
              const FusionSettings& fusion = {});

    /// Allocates and integrates one depth image (metres), and colour seen by the same camera where it is given
    /// (linear).
    void fuse(const Intrinsics& camera, const RigidTransform& world_from_camera, const Image<float>& depth_m,
              const Image<glm::vec4>* color = nullptr);

    struct View {
        Image<glm::vec4> position_m;
        Image<glm::vec4> normal;
    };
    View raycast(const Intrinsics& camera, const RigidTransform& world_from_camera,
                 std::optional<MapAccess> access = {});

    gpu::MapCounters counters();

    VoxelMap& map() { return map_; }
    graph::Runner& runner() { return runner_; }
    const FusionSettings& settings() const { return fusion_; }

  private:
    vulkan::Device& device_;
    graph::Runner& runner_;
    VoxelMap map_;
    FusionSettings fusion_;
    uint32_t frame_ = 0;
};

}  // namespace patina
