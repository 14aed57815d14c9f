#include "passes/input/convert_depth.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "passes/input/lens.h"
#include "shared/input/convert_depth.h"
#include "spirv/shaders.h"

namespace patina {

namespace {

constexpr const char* kConvertDepth = "input.convert_depth";

/// The largest source value that is a reading; compared as a number by the shader.
uint32_t max_code(const DepthInput& input, bool metres) {
    if (metres) return std::bit_cast<uint32_t>(static_cast<float>(input.max_metres));
    // Half a thousandth of a unit absorbs rounding: 8 m of 0.001 m are 8000 units, not 7999.
    return static_cast<uint32_t>(std::min(input.max_metres / input.metres_per_unit + 0.0005, 65535.0));
}

void check_scale(const DepthInput& input) {
    const bool usable = std::isfinite(input.metres_per_unit) && input.metres_per_unit > 0 &&
                        std::isfinite(input.max_metres) && input.max_metres > 0;
    if (!usable) {
        throw Error("the pass '", kConvertDepth, "' got a scale without use: ", input.metres_per_unit,
                    " metres per unit, readings up to ", input.max_metres, " m");
    }
}

}  // namespace

void check_depth(const DepthInput& input) {
    check_scale(input);
    lens_of(input.camera, kConvertDepth);
}

graph::ImageId add_convert_depth(graph::FrameGraph& frame, const DepthInput& input,
                                 std::optional<graph::ImageId> target) {
    check_scale(input);
    const bool metres = std::holds_alternative<std::span<const float>>(input.pixels);
    const Extent2D extent = input.camera.extent;
    const gpu::Lens lens = lens_of(input.camera, kConvertDepth);
    const graph::BufferId source =
        std::visit([&](auto pixels) { return upload_picture(frame, kConvertDepth, extent, pixels); }, input.pixels);

    auto pass = frame.compute(kConvertDepth, spirv::convert_depth);
    pass.read("Source", source).specialise("kMetres", metres).specialise("kDistorted", input.camera.distorted());
    const graph::ImageId depth_m =
        target ? pass.write("depth_m", *target) : pass.create("depth_m", {extent, vulkan::Format::kR32f});
    pass.push(gpu::ConvertDepthParams{lens, static_cast<float>(input.metres_per_unit), max_code(input, metres), 0, 0});
    pass.dispatch_covering(extent);
    return depth_m;
}

}  // namespace patina
