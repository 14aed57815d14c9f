#include "passes/segmentation/sample_labels.h"

#include "engine/core/divided_up.h"
#include "engine/core/error.h"
#include "shared/segmentation/segments.h"
#include "spirv/shaders.h"

namespace patina {

void check_sampled(const char* pass, const char* what, Extent2D full, Extent2D sampled, uint32_t stride) {
    const Extent2D expected = sampled_extent(full, stride);
    if (sampled != expected) {
        throw Error("the pass '", pass, "' got ", what, " of ", sampled, " pixels, it must be ", expected,
                    " for pictures of ", full);
    }
}

graph::ImageId add_sample_labels(graph::FrameGraph& frame, const VoxelMap& map, const LabelMapIds& labels,
                                 graph::BufferId parents, const SurfaceView& surface, MapAccess access,
                                 uint32_t stride) {
    const Extent2D full = frame.common_extent({surface.position_m, surface.normal});
    const Extent2D extent = sampled_extent(full, stride);
    const bool texel = access == MapAccess::kTexel;
    auto pass = frame.compute("segmentation.sample_labels", texel ? spirv::sample_labels_texel : spirv::sample_labels);
    pass.read("position_m", surface.position_m).read("normal", surface.normal);
    pass.read("View", surface.view).read("ViewGrid", surface.view_grid);
    pass.read("Words", labels.words).read("Parents", parents).specialise("kVoxelChunks", map.chunks());
    pass.specialise("kStride", stride);
    const graph::ImageId label = pass.create("map_label", {extent, vulkan::Format::kR32u});
    pass.dispatch(divided_up(extent.width, gpu::kAskGroup), divided_up(extent.height, gpu::kAskRows));
    return label;
}

}  // namespace patina
