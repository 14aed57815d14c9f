#pragma once

#include <map>
#include <optional>
#include <set>

#include "engine/graph/runner.h"
#include "passes/fusion/allocate_blocks.h"
#include "passes/fusion/raycast.h"
#include "passes/state/voxel_map.h"
#include "tests/reference/fusion/integrate.h"
#include "tests/reference/fusion/volume.h"
#include "tests/reference/scenes/analytic_scene.h"

namespace patina {

/// A colour image (linear; a = 0: no reading) with the camera that took it.
struct ColorView {
    Intrinsics camera;
    RigidTransform world_from_camera;
    Image<glm::vec4> linear;
};

/// The map's table and lists as they are on the device.
struct TableContent {
    std::vector<uint32_t> keys, blocks;  ///< by slot
    std::vector<uint32_t> block_keys;    ///< by block id
    std::vector<uint32_t> free_list;     ///< only its valid part
};

/// A block's voxels as stored.
struct BlockContent {
    std::vector<uint32_t> tsdf;
    std::vector<uint32_t> color;

    bool operator==(const BlockContent&) const = default;
};
using MapContent = std::map<reference::BlockCoordinates, BlockContent>;

/// Four half floats per pixel to four floats.
Image<glm::vec4> widen(const Image<uint64_t>& halves);

/// Coordinates of a key in a map around the world's origin.
reference::BlockCoordinates coordinates_of_key(uint32_t key);

/// A map with the passes that fill it, for tests: fuses depth images of analytic scenes and looks at the result.
class FusionRig {
  public:
    FusionRig(vulkan::Device& device, graph::Runner& runner, const VoxelMapSettings& map = {},
              const FusionSettings& fusion = {});

    /// Allocates and integrates one depth image (metres), and colour where it is given.
    void fuse(const Intrinsics& camera, const RigidTransform& world_from_camera, const Image<float>& depth_m,
              const std::optional<ColorView>& color = {});

    /// Removes what is empty of the blocks that a camera sees.
    void remove_empty_blocks(const Intrinsics& camera, const RigidTransform& world_from_camera);

    struct View {
        Image<glm::vec4> position_m;
        Image<glm::vec4> normal;
    };
    View raycast(const Intrinsics& camera, const RigidTransform& world_from_camera,
                 std::optional<MapAccess> access = {});

    gpu::MapCounters counters();
    TableContent table();
    /// Coordinates of all blocks in use.
    std::set<reference::BlockCoordinates> allocated();
    /// All blocks in use with their voxels.
    MapContent content();
    /// The same, unpacked.
    reference::Volume volume();
    /// The fusion's settings as the reference takes them, for the frame that is fused next.
    reference::Fusion reference_fusion() const;

    VoxelMap& map() { return map_; }
    graph::Runner& runner() { return runner_; }
    const FusionSettings& settings() const { return fusion_; }

  private:
    gpu::FusionParams fusion_params(const gpu::Camera& depth_camera, const gpu::Camera& color_camera) const;
    float far_m() const { return fusion_.max_depth_m + 0.1f; }

    vulkan::Device& device_;
    graph::Runner& runner_;
    VoxelMap map_;
    FusionSettings fusion_;
    uint32_t frame_ = 0;
    uint32_t color_frame_ = 0;
};

}  // namespace patina
