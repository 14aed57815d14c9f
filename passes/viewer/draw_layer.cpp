#include "passes/viewer/draw_layer.h"

#include "spirv/shaders.h"

namespace patina {

namespace {

graph::ImageId add_draw(graph::FrameGraph& frame, graph::PassBuilder pass, const DrawnSurface& surface,
                        const gpu::DrawLayerParams& params, graph::ImageId picture) {
    const Extent2D extent = frame.common_extent({surface.position_m, surface.normal, picture});
    pass.read("position_m", surface.position_m).read("normal", surface.normal);
    const graph::ImageId drawn = pass.write("picture", picture);
    pass.push(params);
    pass.dispatch_covering(extent);
    frame.keep(drawn);
    return drawn;
}

}  // namespace

graph::ImageId add_draw_layer(graph::FrameGraph& frame, const DrawnSurface& surface, graph::ImageId value,
                              const gpu::DrawLayerParams& params, graph::ImageId picture) {
    frame.common_extent({surface.position_m, value});
    auto pass = frame.compute("viewer.draw_layer", spirv::draw_layer);
    pass.read("value", value);
    return add_draw(frame, std::move(pass), surface, params, picture);
}

graph::ImageId add_draw_segments(graph::FrameGraph& frame, const DrawnSurface& surface, graph::ImageId label,
                                 const gpu::DrawLayerParams& params, graph::ImageId picture) {
    frame.common_extent({surface.position_m, label});
    auto pass = frame.compute("viewer.draw_segments", spirv::draw_segments);
    pass.read("label", label);
    return add_draw(frame, std::move(pass), surface, params, picture);
}

}  // namespace patina
