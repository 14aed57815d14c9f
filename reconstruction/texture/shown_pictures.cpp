#include "reconstruction/texture/shown_pictures.h"

#include <algorithm>
#include <utility>

#include "passes/texture/albedo_picture.h"
#include "passes/texture/show_texels.h"

namespace patina {

namespace {

constexpr vulkan::Format kAlbedo = vulkan::Format::kRgba16f, kDepth = vulkan::Format::kR32f;
constexpr double kTypicalDepth_m = 2;  // sets how far apart the blocks are that are balanced with each other

}  // namespace

size_t ShownPictures::most_of(const Intrinsics& camera) {
    const uint64_t bytes =
        camera.extent.area() * bytes_per_pixel(kAlbedo) + cast_extent(camera.extent).area() * bytes_per_pixel(kDepth);
    return static_cast<size_t>(std::max(kMostBytes / std::max(bytes, uint64_t{1}), uint64_t{1}));
}

void ShownPictures::add(const TexturePicture& picture) {
    const Intrinsics& camera = picture.color.camera;
    Picture kept;
    kept.camera = make_posed_camera(camera, picture.world_from_camera).gpu;
    vulkan::Device& device = runner_.device();
    kept.albedo = device.create_image({.name = "albedo by a picture", .extent = camera.extent, .format = kAlbedo});
    kept.depth_m =
        device.create_image({.name = "depth of a picture", .extent = cast_extent(camera.extent), .format = kDepth});
    graph::FrameGraph graph = runner_.begin();
    const BlendPictureInputs inputs = add_cast_picture(graph, stages_, picture, graph.import(kept.depth_m));
    graph.keep(inputs.depth_m);
    graph.keep(add_albedo_picture(graph, inputs, graph.import(kept.albedo)));
    runner_.submit(std::move(graph));
    pictures_.push_back(std::move(kept));
}

PredictedImages ShownPictures::add_to_view(graph::FrameGraph& graph, const PosedCamera& camera,
                                           graph::ImageId position_m, graph::ImageId normal,
                                           const PredictedImages& predicted, const PredictedImages& elsewhere) {
    const Extent2D extent = camera.intrinsics.extent;
    if (!page_ || page_->extent() != extent) page_.emplace(runner_.device(), 0, 0, extent);
    ViewTexelIds texels = add_place_view(graph, *page_, position_m, normal, predicted);
    for (const Picture& picture : pictures_) {
        BlendPictureInputs inputs;
        inputs.color = graph.import(picture.albedo);
        inputs.depth_m = graph.import(picture.depth_m);
        inputs.camera = picture.camera;
        inputs.voxel_m = stages_.settings.map.voxel_m;
        texels = add_blend_picture_for(graph, *page_, texels, inputs, glm::vec3(camera.world_from_camera[3]));
    }
    return add_show_texels(graph, *page_, texels,
                           {predicted, elsewhere, kTypicalDepth_m / camera.intrinsics.fx, other_light_});
}

}  // namespace patina
