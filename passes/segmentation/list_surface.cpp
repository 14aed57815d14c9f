#include "passes/segmentation/list_surface.h"

#include "shared/segments.h"
#include "spirv/shaders.h"

namespace patina {

SurfaceBlocks add_list_surface(graph::Frame& frame, const VoxelMap& map, LabelMapIds& labels,
                               const SurfaceView& surface, uint32_t stamp) {
    const Extent2D extent = frame.shape(surface.position_m).extent;
    const uint64_t entries = 1 + map.settings().capacity_blocks;
    SurfaceBlocks out;
    out.list = frame.fill(frame.create_buffer("segmentation.surface", entries * sizeof(uint32_t)), 0, 4);
    out.arguments = frame.fill(frame.create_buffer("segmentation.surface_arguments", 16), 1);
    auto pass = frame.compute("segmentation.list_surface", spirv::list_surface);
    pass.read("position_m", surface.position_m).read("View", surface.view).read("ViewGrid", surface.view_grid);
    pass.push(gpu::ListSurfaceParams{stamp, 0, 0, 0});
    labels.stamps = pass.modify("Stamps", labels.stamps);
    out.list = pass.modify("Surface", out.list);
    out.arguments = pass.modify("Arguments", out.arguments);
    constexpr uint32_t kStride = gpu::kListStride;
    pass.dispatch_covering(Extent2D{(extent.width + kStride - 1) / kStride, (extent.height + kStride - 1) / kStride});
    return out;
}

}  // namespace patina
