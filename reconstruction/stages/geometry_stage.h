#pragma once

#include <cstdint>
#include <optional>

#include "engine/graph/runner.h"
#include "passes/fusion/allocate_blocks.h"
#include "passes/fusion/raycast.h"
#include "passes/fusion/visible_blocks.h"
#include "passes/state/map_access.h"
#include "passes/state/voxel_map.h"
#include "reconstruction/frame_context.h"

namespace patina {

/// What the geometry is made with.
struct GeometrySettings {
    VoxelMapSettings map;
    FusionSettings fusion;
    float near_m = 0.1f;         ///< nothing nearer to a camera is cast
    uint32_t remove_every = 16;  ///< blocks without surface are removed every so many frames; 0 keeps them
    float around_m = 8;          ///< what lies farther from the camera is left alone, but for what frames fuse
};

/// A frame's pictures as they are fused. Those of depth have the depth camera's extent.
struct GeometryInputs {
    graph::ImageId depth_m;               ///< r32f, 0: no reading
    graph::ImageId slope;                 ///< of the readings (add_measure_slope)
    std::optional<graph::ImageId> color;  ///< rgba16f, linear, of the colour camera; empty: none is fused
};

/// The surface: owns the voxel map, fuses depth and colour into it, and casts it into cameras. The functions that add
/// passes are called in the order in which they stand here.
class GeometryStage {
  public:
    /// Throws Error for settings that cannot be met, or lack of memory.
    GeometryStage(vulkan::Device& device, const GeometrySettings& settings);

    /// Empties the map, placing it around `center_m`; the first thing done with it.
    void reset(graph::FrameGraph& graph, glm::dvec3 center_m) { map_.reset(graph, center_m); }

    /// Which depths of a depth camera count. `reach_m` is fusion.max_depth_m, or less where with such small voxels the
    /// view of the map does not reach so far (view_reach_m).
    DepthRange range(const Intrinsics& camera) const;

    /// The blocks that a frame's passes look at: those in the views of both its cameras, as far as frames are fused,
    /// and those around it.
    StreamRegion around(const PosedCamera& depth, const PosedCamera& color) const;
    /// The blocks that a view is cast from (add_visible_to_view), and those around its camera.
    StreamRegion around_view(const PosedCamera& camera) const;

    /// What a frame's fusion passes share: gpu::FusionParams.
    graph::BufferId add_params(graph::FrameGraph& graph, const FrameContext& frame) const;

    /// Gives blocks to the surface that a frame's readings show (touch, then assign).
    void add_allocate(graph::FrameGraph& graph, VoxelMapIds& voxels, graph::ImageId depth_m, graph::BufferId params,
                      const FrameContext& frame) const;

    /// The blocks that a depth camera sees, as far as frames are fused.
    VisibleBlocks add_visible(graph::FrameGraph& graph, const VoxelMapIds& voxels, const PosedCamera& camera) const;
    /// The blocks that any camera sees, up to twice fusion.max_depth_m.
    VisibleBlocks add_visible_to_view(graph::FrameGraph& graph, const VoxelMapIds& voxels,
                                      const PosedCamera& camera) const;

    /// Fuses a frame into the blocks that its camera sees.
    void add_integrate(graph::FrameGraph& graph, VoxelMapIds& voxels, const VisibleBlocks& visible,
                       graph::BufferId params, const GeometryInputs& inputs) const;

    /// The surface as the camera of `visible` sees it.
    RaycastImages add_raycast(graph::FrameGraph& graph, const VoxelMapIds& voxels, const VisibleBlocks& visible) const;
    /// The same with normals for shading (add_sharpen_normals).
    RaycastImages add_sharpened(graph::FrameGraph& graph, const RaycastImages& cast, const Intrinsics& camera) const;

    /// Gives back blocks without surface, in the frames in which that is due.
    void add_remove_empty(graph::FrameGraph& graph, VoxelMapIds& voxels, const VisibleBlocks& visible,
                          graph::BufferId params, uint32_t frame_index) const;

    void visit(graph::StateVisitor& visitor) { map_.visit(visitor); }

    /// A voxel that was seen nearer to the surface than this, metres, keeps its block from being removed.
    float near_surface_m() const;

    VoxelMap& map() { return map_; }
    const VoxelMap& map() const { return map_; }
    MapAccess access() const { return access_; }

  private:
    /// Of the pixels that allocate blocks.
    uint32_t allocation_stride_px(const FrameContext& frame) const;

    float far_m() const;
    float view_far_m() const { return 2 * settings_.fusion.max_depth_m; }
    StreamRegion seen_by(const PosedCamera& camera, float far_m) const;

    GeometrySettings settings_;
    VoxelMap map_;
    MapAccess access_;
};

}  // namespace patina
