#include "passes/input/input.h"

#include "passes/input/convert_color.h"
#include "passes/input/convert_depth.h"

namespace patina {

InputImages add_input(graph::Frame& frame, const DepthInput& depth, const ColorInput& color,
                      const gpu::Camera& depth_camera, const InputSettings& settings) {
    InputImages images;
    images.depth_m = add_convert_depth(frame, depth);
    images.filtered_depth_m = add_filter_depth(frame, images.depth_m, settings.filter);
    images.surface = add_unproject_depth(frame, images.filtered_depth_m, depth_camera, settings.jump);
    images.color = add_convert_color(frame, color);
    return images;
}

}  // namespace patina
