#include "passes/fusion/allocate_blocks.h"

#include <algorithm>

#include "engine/core/error.h"
#include "spirv/shaders.h"

namespace patina {

gpu::FusionParams make_fusion_params(const VoxelMap& map, const FusionSettings& settings,
                                     const gpu::Camera& depth_camera, const gpu::Camera& color_camera,
                                     uint32_t frame_index, uint32_t color_frame) {
    const float voxel_m = map.settings().voxel_m;
    gpu::FusionParams params{};
    params.grid = map.grid();
    params.depth_camera = depth_camera;
    params.color_camera = color_camera;
    params.truncation_m = least_truncation_m(settings, voxel_m);
    params.truncation_slope = settings.truncation_slope;
    params.max_depth_m = settings.max_depth_m;
    const float widest_m = params.truncation_m + params.truncation_slope * params.max_depth_m;
    if (widest_m > gpu::kSdfRangeVox * voxel_m) {
        throw Error("the truncation band is ", widest_m, " m wide at ", settings.max_depth_m, " m, voxels of ", voxel_m,
                    " m hold at most ", gpu::kSdfRangeVox * voxel_m, " m");
    }
    constexpr uint32_t kMostSamples = UINT16_MAX / gpu::kWeightOne;
    if (settings.max_weight == 0 || settings.max_weight > kMostSamples) {
        throw Error("the largest weight of a voxel is ", settings.max_weight, " samples, it must be 1 to ",
                    kMostSamples);
    }
    params.max_weight = static_cast<float>(settings.max_weight * gpu::kWeightOne);
    // Marching cubes and ray casting interpolate colour between voxels up to a cell's diagonal off the surface.
    params.color_band_m = 1.8f * voxel_m;
    params.max_color_weight = static_cast<float>(settings.max_color_weight * gpu::kWeightOne);
    params.stride_px = std::max(settings.allocation_stride_px, 1u);
    // A permutation of the stride^2 phases: neighbours in time are apart in space.
    params.phase = frame_index * 5u % (params.stride_px * params.stride_px);
    params.max_table_keys = map.table_slots() / 2;
    params.frame_index = frame_index;
    params.settled_weight = 0.5f * params.max_weight;
    params.settled_color_every = std::max(settings.settled_color_every, 1u);
    params.color_frame = color_frame;
    params.seed = settings.seed;
    params.inverse_sdf_range = 1 / (gpu::kSdfRangeVox * voxel_m);
    return params;
}

void add_allocate_blocks(graph::FrameGraph& frame, const VoxelMap& map, VoxelMapIds& ids, graph::ImageId depth_m,
                         graph::BufferId params, uint32_t stride_px) {
    auto touch = frame.compute("fusion.touch_blocks", spirv::touch_blocks);
    touch.read("depth_m", depth_m).read("Fusion", params);
    ids.keys = touch.modify("Keys", ids.keys);
    ids.new_slots = touch.write("NewSlots", ids.new_slots);
    ids.counters = touch.modify("Counters", ids.counters);
    const Extent2D extent = frame.shape(depth_m).extent;
    touch.dispatch_covering(
        Extent2D{(extent.width + stride_px - 1) / stride_px, (extent.height + stride_px - 1) / stride_px});

    auto select = frame.compute("fusion.select_blocks", spirv::select_blocks);
    select.read("Keys", ids.keys).read("NewSlots", ids.new_slots).push(map.grid());
    ids.counters = select.modify("Counters", ids.counters);
    ids.assign_arguments = select.write("AssignArguments", ids.assign_arguments);
    ids.block_arguments = select.write("BlockArguments", ids.block_arguments);
    select.dispatch(1);

    auto assign = frame.compute("fusion.assign_blocks", spirv::assign_blocks);
    assign.read("Keys", ids.keys).read("NewSlots", ids.new_slots).read("FreeList", ids.free_list).push(map.grid());
    assign.specialise("kVoxelChunks", map.chunks());
    ids.counters = assign.modify("Counters", ids.counters);
    ids.blocks = assign.modify("Blocks", ids.blocks);
    ids.block_keys = assign.modify("BlockKeys", ids.block_keys);
    ids.tsdf = assign.modify("Tsdf", ids.tsdf);
    ids.color = assign.modify("Color", ids.color);
    assign.dispatch_indirect(ids.assign_arguments);
}

}  // namespace patina
