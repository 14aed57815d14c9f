#include "scenes/render/encode.h"

#include "shared/scenes/encode_color.h"
#include "shared/scenes/encode_depth.h"
#include "shared/scenes/expose_color.h"
#include "spirv/shaders.h"

namespace patina::scenes {
namespace {

/// Low word first.
glm::uvec2 words_of(uint64_t seed) { return {static_cast<uint32_t>(seed), static_cast<uint32_t>(seed >> 32)}; }

}  // namespace

graph::BufferId add_encode_depth(graph::FrameGraph& frame, const RenderedImages& rendered, double metres_per_unit,
                                 const SensorNoise& noise, const NoiseKey& key) {
    const Extent2D extent = frame.common_extent({rendered.depth_m, rendered.object_id});
    auto pass = frame.compute("scenes.encode_depth", spirv::encode_depth);
    pass.read("depth_m", rendered.depth_m).read("object_id", rendered.object_id);
    const graph::BufferId encoded = pass.create("Encoded", extent.area() * sizeof(uint32_t));
    pass.push(gpu::EncodeDepthParams{.extent = {extent.width, extent.height},
                                     .units_per_metre = static_cast<float>(1 / metres_per_unit),
                                     .constant_m = static_cast<float>(noise.depth_constant_m),
                                     .quadratic_per_m = static_cast<float>(noise.depth_quadratic_per_m),
                                     .offset_m = static_cast<float>(noise.depth_offset_m),
                                     .flying_pixels = static_cast<float>(noise.flying_pixels),
                                     .frame = key.frame,
                                     .seed = words_of(key.seed)});
    pass.dispatch_covering(extent);
    return encoded;
}

graph::ImageId add_expose_color(graph::FrameGraph& frame, graph::ImageId radiance, double exposure,
                                const SensorNoise& noise, const NoiseKey& key) {
    const Extent2D extent = frame.shape(radiance).extent;
    auto pass = frame.compute("scenes.expose_color", spirv::expose_color);
    pass.read("radiance", radiance);
    const graph::ImageId linear_color = pass.create("linear_color", {extent, vulkan::Format::kRgba32f});
    pass.push(gpu::ExposeColorParams{.extent = {extent.width, extent.height},
                                     .exposure = static_cast<float>(exposure),
                                     .read = static_cast<float>(noise.color_read),
                                     .shot = static_cast<float>(noise.color_shot),
                                     .frame = key.frame,
                                     .seed = words_of(key.seed)});
    pass.dispatch_covering(extent);
    return linear_color;
}

graph::BufferId add_encode_color(graph::FrameGraph& frame, graph::ImageId linear_color) {
    const Extent2D extent = frame.shape(linear_color).extent;
    auto pass = frame.compute("scenes.encode_color", spirv::encode_color);
    pass.read("linear_color", linear_color);
    const graph::BufferId codes = pass.create("Codes", extent.area() * sizeof(uint32_t));
    pass.push(gpu::EncodeColorParams{{extent.width, extent.height}});
    pass.dispatch_covering(extent);
    return codes;
}

}  // namespace patina::scenes
