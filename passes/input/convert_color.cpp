#include "passes/input/convert_color.h"

#include "passes/input/lens.h"
#include "shared/input/convert_color.h"
#include "spirv/shaders.h"

namespace patina {

namespace {

constexpr const char* kConvertColor = "input.convert_color";

}  // namespace

void check_color(const ColorInput& input) { lens_of(input.camera, kConvertColor); }

graph::ImageId add_convert_color(graph::FrameGraph& frame, const ColorInput& input,
                                 std::optional<graph::ImageId> target) {
    const bool linear = std::holds_alternative<std::span<const glm::vec3>>(input.pixels);
    const Extent2D extent = input.camera.extent;
    const gpu::Lens lens = lens_of(input.camera, kConvertColor);
    const graph::BufferId source =
        std::visit([&](auto pixels) { return upload_picture(frame, kConvertColor, extent, pixels); }, input.pixels);

    auto pass = frame.compute(kConvertColor, spirv::convert_color);
    pass.read("Source", source).specialise("kLinear", linear).specialise("kDistorted", input.camera.distorted());
    const graph::ImageId color =
        target ? pass.write("color", *target) : pass.create("color", {extent, vulkan::Format::kRgba16f});
    pass.push(gpu::ConvertColorParams{lens});
    pass.dispatch_covering(extent);
    return color;
}

}  // namespace patina
