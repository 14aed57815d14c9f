#include "reconstruction/stages/geometry_stage.h"

#include <algorithm>
#include <cmath>

#include "engine/core/error.h"
#include "passes/fusion/integrate.h"
#include "passes/fusion/remove_empty_blocks.h"
#include "passes/fusion/sharpen_normals.h"
#include "shared/fusion/remove_empty_blocks.h"

namespace patina {

namespace {

/// Throws Error for what would make shaders divide by zero, or a weight outgrow its 16 bits.
const GeometrySettings& checked(const GeometrySettings& settings) {
    const auto check_range = [](const char* name, uint32_t value, uint32_t most) {
        if (value == 0 || value > most) throw Error(name, " is ", value, ", it must be 1 to ", most);
    };
    check_range("fusion.allocation_stride_px", settings.fusion.allocation_stride_px, 64);
    check_range("fusion.max_weight", settings.fusion.max_weight, 65535);
    check_range("fusion.max_color_weight", settings.fusion.max_color_weight, 65535);
    check_range("fusion.settled_color_every", settings.fusion.settled_color_every, 64);
    return settings;
}

}  // namespace

GeometryStage::GeometryStage(vulkan::Device& device, const GeometrySettings& settings)
    : settings_(checked(settings)), map_(device, settings.map), access_(preferred_map_access(device.caps(), map_)) {}

float GeometryStage::near_surface_m() const {
    return gpu::kSurfaceTruncation * least_truncation_m(settings_.fusion, settings_.map.voxel_m);
}

float GeometryStage::far_m() const {
    const FusionSettings& fusion = settings_.fusion;
    const float truncation_m = least_truncation_m(fusion, settings_.map.voxel_m);
    return fusion.max_depth_m + truncation_m + fusion.truncation_slope * fusion.max_depth_m;
}

DepthRange GeometryStage::range(const Intrinsics& camera) const {
    DepthRange range{settings_.near_m, far_m(), settings_.fusion.max_depth_m};
    const PosedCamera posed = make_posed_camera(camera, RigidTransform(1));
    const float seen_m = view_reach_m(posed.gpu, settings_.map.voxel_m, range.far_m);
    if (seen_m >= range.far_m) return range;
    // Behind a surface there is room for its truncation band.
    const float truncation_m = least_truncation_m(settings_.fusion, settings_.map.voxel_m);
    range.reach_m = (seen_m - truncation_m) / (1 + settings_.fusion.truncation_slope);
    return range;
}

StreamRegion GeometryStage::seen_by(const PosedCamera& camera, float far_m) const {
    const double beside_m = StreamRegion::kBlocksBeside * double{settings_.map.voxel_m} * gpu::kBlockEdge;
    StreamRegion region = StreamRegion::ball(glm::dvec3(camera.world_from_camera[3]), settings_.around_m);
    region.axis = glm::normalize(glm::dvec3(camera.world_from_camera[2]));
    region.far_m = frustum_radius_m(camera.gpu, far_m);
    region.half_angle = std::acos(far_m / region.far_m);
    return region.grown(beside_m);
}

StreamRegion GeometryStage::around(const PosedCamera& depth, const PosedCamera& color) const {
    StreamRegion region = seen_by(depth, far_m());
    const StreamRegion beside = seen_by(color, far_m());
    const double turned = std::acos(std::clamp(glm::dot(region.axis, beside.axis), -1.0, 1.0));
    region.half_angle = std::min(std::max(region.half_angle, beside.half_angle + turned), StreamRegion::kWidest);
    region.far_m = std::max(region.far_m, beside.far_m);
    return region.grown(glm::distance(region.center_m, beside.center_m));
}

StreamRegion GeometryStage::around_view(const PosedCamera& camera) const { return seen_by(camera, view_far_m()); }

uint32_t GeometryStage::allocation_stride_px(const FrameContext& frame) const {
    return frame.stride_px(settings_.fusion.allocation_stride_px, double{settings_.map.voxel_m} * gpu::kBlockEdge);
}

graph::BufferId GeometryStage::add_params(graph::FrameGraph& graph, const FrameContext& frame) const {
    // What the view does not reach would take blocks that no frame fuses into.
    FusionSettings fusion = settings_.fusion;
    fusion.max_depth_m = frame.range.reach_m;
    fusion.allocation_stride_px = allocation_stride_px(frame);
    const gpu::FusionParams values =
        make_fusion_params(map_, fusion, frame.depth.gpu, frame.color.gpu, frame.index, frame.color_index);
    return graph.upload<gpu::FusionParams>("fusion.params", std::span(&values, 1));
}

void GeometryStage::add_allocate(graph::FrameGraph& graph, VoxelMapIds& voxels, graph::ImageId depth_m,
                                 graph::BufferId params, const FrameContext& frame) const {
    add_allocate_blocks(graph, map_, voxels, depth_m, params, allocation_stride_px(frame));
}

VisibleBlocks GeometryStage::add_visible(graph::FrameGraph& graph, const VoxelMapIds& voxels,
                                         const PosedCamera& camera) const {
    return add_visible_blocks(graph, map_, voxels, camera.gpu, settings_.near_m, far_m());
}

VisibleBlocks GeometryStage::add_visible_to_view(graph::FrameGraph& graph, const VoxelMapIds& voxels,
                                                 const PosedCamera& camera) const {
    return add_visible_blocks(graph, map_, voxels, camera.gpu, settings_.near_m, view_far_m());
}

void GeometryStage::add_integrate(graph::FrameGraph& graph, VoxelMapIds& voxels, const VisibleBlocks& visible,
                                  graph::BufferId params, const GeometryInputs& inputs) const {
    patina::add_integrate(graph, map_, voxels, visible, params, inputs.depth_m, inputs.slope, inputs.color);
}

RaycastImages GeometryStage::add_raycast(graph::FrameGraph& graph, const VoxelMapIds& voxels,
                                         const VisibleBlocks& visible) const {
    return patina::add_raycast(graph, map_, voxels, visible, access_);
}

RaycastImages GeometryStage::add_sharpened(graph::FrameGraph& graph, const RaycastImages& cast,
                                           const Intrinsics& camera) const {
    return add_sharpen_normals(graph, cast, static_cast<float>(camera.fx), settings_.map.voxel_m);
}

void GeometryStage::add_remove_empty(graph::FrameGraph& graph, VoxelMapIds& voxels, const VisibleBlocks& visible,
                                     graph::BufferId params, uint32_t frame_index) const {
    const uint32_t every = settings_.remove_every;
    if (every == 0 || frame_index % every != every - 1) return;
    add_remove_empty_blocks(graph, map_, voxels, visible, params);
}

}  // namespace patina
