#include "passes/input/input.h"

#include "passes/input/convert_color.h"
#include "passes/input/convert_depth.h"

namespace patina {

InputImages add_input(graph::FrameGraph& frame, const InputPictures& pictures, const gpu::Camera& depth_camera,
                      const InputSettings& settings) {
    InputImages images;
    images.depth_m = pictures.depth_m;
    images.filtered_depth_m = add_filter_depth(frame, images.depth_m, settings.filter);
    images.surface = add_unproject_depth(frame, images.filtered_depth_m, depth_camera, settings.jump);
    images.color = pictures.color;
    return images;
}

InputImages add_input(graph::FrameGraph& frame, const DepthInput& depth, const ColorInput& color,
                      const gpu::Camera& depth_camera, const InputSettings& settings) {
    const InputPictures pictures{add_convert_depth(frame, depth), add_convert_color(frame, color)};
    return add_input(frame, pictures, depth_camera, settings);
}

}  // namespace patina
