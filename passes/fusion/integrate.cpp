#include "passes/fusion/integrate.h"

#include "shared/fusion/integrate.h"
#include "spirv/shaders.h"

namespace patina {

namespace {

/// What integration leaves for the colour pass.
struct ColorWork {
    graph::BufferId near_surface;  ///< kIntegrateGroup words per visible block: bit 4 i + j of word
                                   ///< k: voxel j of quad i kIntegrateGroup + k is near the surface
    graph::BufferId blocks;        ///< u32: count, then items of the visible list
    graph::BufferId arguments;     ///< one group per listed block, in rows of gpu::kGroupsPerRow
};

ColorWork make_color_work(graph::FrameGraph& frame, const VoxelMap& map) {
    const uint64_t capacity = map.capacity();
    return {
        frame.create_buffer("fusion.near_surface", capacity * gpu::kIntegrateGroup * sizeof(uint32_t)),
        frame.fill(frame.create_buffer("fusion.color_blocks", (1 + capacity) * sizeof(uint32_t)), 0, sizeof(uint32_t)),
        frame.fill(frame.create_buffer("fusion.color_arguments", 16), 1)};
}

}  // namespace

void add_integrate(graph::FrameGraph& frame, const VoxelMap& map, VoxelMapIds& ids, const VisibleBlocks& visible,
                   graph::BufferId params, graph::ImageId depth_m, graph::ImageId slope,
                   std::optional<graph::ImageId> color_linear) {
    auto pass = frame.compute("fusion.integrate", color_linear ? spirv::integrate_marking : spirv::integrate);
    pass.read("Visible", visible.list)
        .read("BlockKeys", ids.block_keys)
        .read("Fusion", params)
        .read("depth_m", depth_m)
        .read("slope", slope);
    pass.specialise("kVoxelChunks", map.chunks());
    ids.tsdf = pass.modify("Tsdf", ids.tsdf);
    if (!color_linear) {
        pass.dispatch_indirect(visible.arguments);
        return;
    }
    ColorWork work = make_color_work(frame, map);
    work.near_surface = pass.write("NearSurface", work.near_surface);
    work.blocks = pass.modify("ColorBlocks", work.blocks);
    work.arguments = pass.modify("ColorArguments", work.arguments);
    pass.dispatch_indirect(visible.arguments);

    auto color = frame.compute("fusion.integrate_color", spirv::integrate_color);
    color.read("Visible", visible.list)
        .read("BlockKeys", ids.block_keys)
        .read("Fusion", params)
        .read("NearSurface", work.near_surface)
        .read("ColorBlocks", work.blocks)
        .read("color_linear", *color_linear)
        .read("Tsdf", ids.tsdf);
    color.specialise("kVoxelChunks", map.chunks());
    ids.color = color.modify("Color", ids.color);
    color.dispatch_indirect(work.arguments);
}

}  // namespace patina
