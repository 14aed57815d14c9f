#include "reconstruction/stages/color_correction.h"

#include "engine/core/error.h"
#include "passes/fusion/shade_color.h"

namespace patina {

namespace {

Extent2D reduced(Extent2D extent, uint32_t reduction) {
    return {(extent.width + reduction - 1) / reduction, (extent.height + reduction - 1) / reduction};
}

const GainSettings& checked(const GainSettings& settings) {
    if (settings.reduction == 0 || settings.reduction > 64) {
        throw Error("gains.reduction is ", settings.reduction, ", it must be 1 to 64");
    }
    return settings;
}

}  // namespace

ColorCorrection::ColorCorrection(vulkan::Device& device, const VoxelMap& map, const GainSettings& settings,
                                 MapAccess access)
    : map_(map),
      settings_(checked(settings)),
      access_(access),
      last_(device.create_buffer({.name = "colour gains", .bytes = sizeof(gpu::ColorGains)})) {}

void ColorCorrection::reset(graph::FrameGraph& graph) {
    pending_.clear();
    gains_.clear();
    const gpu::ColorGains none{glm::vec4(1), glm::uvec4(0)};
    graph.keep(graph.upload_bytes(graph.import(last_), 0, std::as_bytes(std::span(&none, 1)), true));
}

graph::ImageId ColorCorrection::add(graph::FrameGraph& graph, const VoxelMapIds& ids, graph::ImageId color_linear,
                                    const FrameContext& frame) {
    const Extent2D coarse = reduced(frame.color.intrinsics.extent, settings_.reduction);
    const PosedCamera camera = resized(frame.color, coarse);
    const VisibleBlocks visible =
        add_visible_blocks(graph, map_, ids, camera.gpu, frame.range.near_m, frame.range.far_m);
    const RaycastImages model = add_raycast(graph, map_, ids, visible, access_);
    GainInputs inputs;
    inputs.position_m = model.position_m;
    inputs.normal = model.normal;
    inputs.model_color = add_shade_color(graph, map_, ids, visible, model.position_m);
    inputs.color_linear = color_linear;
    inputs.camera_m = glm::vec3(frame.color.world_from_camera[3]);
    const graph::BufferId gains = add_estimate_gains(graph, inputs, graph.import(last_), settings_);
    graph.keep(gains);
    pending_.push_back(graph.read_back(gains));
    return add_apply_gains(graph, color_linear, gains);
}

const std::vector<gpu::ColorGains>& ColorCorrection::gains() {
    for (; !pending_.empty() && pending_.front().ready(); pending_.pop_front())
        gains_.push_back(pending_.front().as<gpu::ColorGains>().front());
    return gains_;
}

void ColorCorrection::visit(graph::StateVisitor& visitor) {
    gains();  // all are there: the device has finished
    visitor.values("gains.all", gains_);
    visitor.buffer(last_);
}

}  // namespace patina
