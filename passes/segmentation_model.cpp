#include "passes/segmentation_model.h"

#include "passes/input/unproject_depth.h"
#include "passes/segmentation/assign_labels.h"
#include "passes/segmentation/claim_voxels.h"
#include "passes/segmentation/clear_labels.h"
#include "passes/segmentation/count_overlaps.h"
#include "passes/segmentation/sample_labels.h"
#include "passes/segmentation/sweep_labels.h"
#include "passes/segmentation/update_labels.h"

namespace patina {

SegmentationModel::SegmentationModel(vulkan::Device& device, const VoxelMap& map, const SegmentationSettings& settings)
    : map_(map),
      settings_(settings),
      labels_(device, map),
      table_(device, settings.capacity_labels) {}

gpu::SegmentationParams SegmentationModel::params(const gpu::Camera& color_camera, Extent2D extent,
                                                  uint32_t frame_index) const {
    gpu::SegmentationParams params{};
    params.color_camera = color_camera;
    params.extent = {extent.width, extent.height};
    params.stamp = frame_index + 1;
    params.capacity = settings_.capacity_labels;
    params.overlap_slots = overlap_slots(extent);
    params.given = settings_.given ? 1 : 0;
    params.inherit_share = settings_.inherit_share;
    params.inherit_pixels = settings_.inherit_pixels;
    params.merge_share = settings_.merge_share;
    params.merge_count = settings_.merge_frames;
    params.merge_chroma = settings_.merge_chroma;
    params.new_pixels = settings_.new_pixels;
    params.prune_voxels = settings_.prune_voxels;
    params.prune_frames = settings_.prune_frames;
    return params;
}

void SegmentationModel::clear_new_blocks(graph::Frame& frame, const VoxelMapIds& voxels) const {
    add_clear_labels(frame, map_, voxels, labels_.import(frame));
}

FrameSegments SegmentationModel::segments(graph::Frame& frame, const SegmentationInputs& inputs,
                                          const gpu::Camera& depth_camera) const {
    const SegmentSettings& settings = settings_.frame;
    const SurfaceInputs surfaces{inputs.model.position_m, inputs.model.normal, inputs.depth_m,
                                 add_unproject_depth(frame, inputs.depth_m, depth_camera).normal};
    const graph::ImageId surface = add_choose_surface(frame, surfaces, depth_camera, settings.edges);
    if (inputs.given) return add_given_segments(frame, *inputs.given, surface, depth_camera, settings.capacity);
    return add_segment_frame(frame, surface, depth_camera, settings);
}

graph::ImageId SegmentationModel::add(graph::Frame& frame, const VoxelMapIds& voxels, const VisibleBlocks& visible,
                                      const SegmentationInputs& inputs, const gpu::Camera& depth_camera,
                                      const gpu::Camera& color_camera, uint32_t frame_index) const {
    const FrameSegments seen = segments(frame, inputs, depth_camera);
    const gpu::SegmentationParams values = params(color_camera, visible.extent, frame_index);
    const auto uniforms = frame.upload<gpu::SegmentationParams>("segmentation.params", std::span(&values, 1));
    SegmentTableIds table = table_.import(frame);
    const ClaimedVoxels claimed =
        add_claim_voxels(frame, map_, labels_.import(frame), table.parents, visible, inputs.model);
    const SegmentOverlaps overlaps = add_count_overlaps(frame, table, seen, claimed.label, inputs.model.position_m,
                                                        inputs.color_linear, uniforms);
    const graph::BufferId assigned = add_assign_labels(frame, table, seen, overlaps, uniforms);
    const UpdatedLabels updated = add_update_labels(frame, map_, claimed, table, seen, assigned);
    frame.keep(add_sweep_labels(frame, map_, voxels, updated.words, table, uniforms));
    SegmentTable::keep(frame, table);
    return updated.label;
}

graph::ImageId SegmentationModel::add_view(graph::Frame& frame, const VisibleBlocks& visible,
                                           const RaycastImages& model) const {
    return add_sample_labels(frame, map_, labels_.import(frame), table_.import(frame).parents, visible, model);
}

std::vector<VoxelMap::PoolBytes> SegmentationModel::memory() const {
    return {{"voxel labels", labels_.bytes()}, {"segments", table_.bytes()}};
}

}  // namespace patina
