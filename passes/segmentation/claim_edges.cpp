#include "passes/segmentation/claim_edges.h"

#include <cmath>

#include "engine/core/divided_up.h"
#include "shared/segmentation/contacts.h"
#include "spirv/shaders.h"

namespace patina {

ClaimedEdges add_claim_edges(graph::FrameGraph& frame, graph::ImageId component, graph::BufferId pixels,
                             const FrameSurface& surface, graph::ImageId normal,
                             const gpu::FrameSurfaceParams& params) {
    const Extent2D extent = frame.common_extent({component, surface.depth_m, surface.chroma, normal});
    const auto zeros = [&](const char* name, uint64_t bytes) {
        return frame.fill(frame.create_buffer(name, bytes), 0);
    };
    auto pass = frame.compute("segmentation.claim_edges", spirv::claim_edges);
    pass.read("depth_m", surface.depth_m).read("chroma", surface.chroma).read("normal", normal);
    pass.read("component", component).read("Pixels", pixels).push(params);
    const ClaimedEdges out{
        pass.create("claimed", {extent, vulkan::Format::kR32u}),
        {pass.modify("Contacts", zeros("segmentation.contacts", gpu::kContactSlots * sizeof(gpu::Contact))),
         pass.modify("ContactCount", zeros("segmentation.contact_count", sizeof(uint32_t)))}};
    pass.dispatch(divided_up(extent.width, gpu::kClaimGroup), divided_up(extent.height, gpu::kClaimRows));
    return out;
}

graph::BufferId add_join_folds(graph::FrameGraph& frame, const Contacts& contacts, graph::BufferId parents,
                               graph::BufferId pixels, const FoldSettings& settings) {
    auto pass = frame.compute("segmentation.join_folds", spirv::join_folds);
    pass.read("Contacts", contacts.table).read("ContactCount", contacts.count);
    pass.push(gpu::JoinFoldsParams{settings.strong_chroma, std::sin(glm::radians(settings.same_hue_degrees)),
                                   settings.same_saturation, settings.least_weight});
    pass.modify("Parents", parents);
    const graph::BufferId joined = pass.modify("Pixels", pixels);
    pass.dispatch(1);
    return joined;
}

}  // namespace patina
