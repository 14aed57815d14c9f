#include "reconstruction/texture/shown_pictures.h"

#include <algorithm>
#include <utility>

#include "passes/texture/blend_diffuse.h"
#include "passes/texture/show_texels.h"

namespace patina {

namespace {

constexpr vulkan::Format kColor = vulkan::Format::kRgba16f, kDepth = vulkan::Format::kR32f;
constexpr double kTypicalDepth_m = 2;  // sets how far apart the blocks are that are balanced with each other

}  // namespace

size_t ShownPictures::most_of(const Intrinsics& camera) {
    const uint64_t bytes = 2 * camera.extent.area() * bytes_per_pixel(kColor) +
                           cast_extent(camera.extent).area() * bytes_per_pixel(kDepth);
    return static_cast<size_t>(std::max(kMostBytes / std::max(bytes, uint64_t{1}), uint64_t{1}));
}

void ShownPictures::add(const TexturePicture& picture) {
    const Intrinsics& camera = picture.color.camera;
    Picture kept;
    kept.camera = make_posed_camera(camera, picture.world_from_camera).gpu;
    vulkan::Device& device = runner_.device();
    kept.diffuse = device.create_image({.name = "diffuse picture", .extent = camera.extent, .format = kColor});
    kept.light = device.create_image({.name = "light of a picture", .extent = camera.extent, .format = kColor});
    kept.depth_m =
        device.create_image({.name = "depth of a picture", .extent = cast_extent(camera.extent), .format = kDepth});
    graph::FrameGraph graph = runner_.begin();
    const BlendPictureInputs inputs = add_cast_picture(graph, stages_, picture, graph.import(kept.depth_m));
    graph.keep(inputs.depth_m);
    const DiffusePicture taken =
        add_diffuse_picture(graph, inputs, {graph.import(kept.diffuse), graph.import(kept.light)});
    graph.keep(taken.diffuse);
    graph.keep(taken.light);
    runner_.submit(std::move(graph));
    pictures_.push_back(std::move(kept));
}

PredictedImages ShownPictures::add_to_view(graph::FrameGraph& graph, const PosedCamera& camera,
                                           graph::ImageId position_m, graph::ImageId normal,
                                           const PredictedImages& predicted, const PredictedImages& elsewhere) {
    const Extent2D extent = camera.intrinsics.extent;
    if (extent.height > TextureBand::most_rows(extent.width)) return elsewhere;
    if (!page_ || page_->extent() != extent) page_.emplace(runner_.device(), 0, 0, extent);
    ViewTexelIds texels = add_place_view(graph, *page_, position_m, normal, predicted.kd);
    for (const Picture& picture : pictures_) {
        BlendDiffuseInputs inputs;
        inputs.picture = {graph.import(picture.diffuse), graph.import(picture.light)};
        inputs.depth_m = graph.import(picture.depth_m);
        inputs.camera = picture.camera;
        inputs.voxel_m = stages_.settings.map.voxel_m;
        inputs.eye_m = glm::vec3(camera.world_from_camera[3]);
        texels = add_blend_diffuse(graph, *page_, texels, inputs);
    }
    ShowTexelsInputs inputs;
    inputs.kd = predicted.kd;
    inputs.rgb = predicted.rgb;
    inputs.picture_kd = predicted.picture_kd;
    inputs.light = predicted.light;
    inputs.kd_elsewhere = elsewhere.kd;
    inputs.rgb_elsewhere = elsewhere.rgb;
    inputs.pixel_m = kTypicalDepth_m / camera.intrinsics.fx;
    inputs.other_light = other_light_;
    const ShownTexels shown_texels = add_show_texels(graph, *page_, texels, inputs);
    PredictedImages shown = elsewhere;
    shown.kd = shown_texels.kd;
    shown.rgb = shown_texels.rgb;
    return shown;
}

}  // namespace patina
