#include "reconstruction/kept_input.h"

#include "engine/vulkan/device.h"
#include "passes/input/convert_color.h"
#include "passes/input/convert_depth.h"

namespace patina {

namespace {

uint64_t bytes_of(const vulkan::ImageRef& image) {
    return image ? image->desc().extent.area() * bytes_per_pixel(image->desc().format) : 0;
}

}  // namespace

InputPictures KeptInput::add(graph::FrameGraph& frame, const DepthInput& depth, const ColorInput& color) {
    const auto fit = [&](vulkan::ImageRef& image, const char* name, Extent2D extent, vulkan::Format format) {
        if (!image || image->desc().extent != extent)
            image = device_.create_image({.name = name, .extent = extent, .format = format});
        return frame.import(image);
    };
    const graph::ImageId kept_depth = fit(depth_m_, "kept depth", depth.camera.extent, vulkan::Format::kR32f);
    const graph::ImageId kept_color = fit(color_, "kept color", color.camera.extent, vulkan::Format::kRgba16f);
    const InputPictures pictures{add_convert_depth(frame, depth, kept_depth),
                                 add_convert_color(frame, color, kept_color)};
    frame.keep(pictures.depth_m);
    frame.keep(pictures.color);
    return pictures;
}

uint64_t KeptInput::bytes() const { return bytes_of(depth_m_) + bytes_of(color_); }

}  // namespace patina
