#include "reconstruction/texture/cast_picture.h"

#include <algorithm>

#include "passes/input/convert_color.h"
#include "passes/texture/cast_depth.h"

namespace patina {

namespace {

constexpr uint32_t kMostCast_px = 640;

}  // namespace

Extent2D cast_extent(Extent2D picture) {
    const uint32_t longest = std::max(picture.width, picture.height);
    if (longest <= kMostCast_px) return picture;
    const auto scaled = [&](uint32_t px) { return std::max((px * kMostCast_px + longest / 2) / longest, 1u); };
    return {scaled(picture.width), scaled(picture.height)};
}

BlendPictureInputs add_cast_picture(graph::FrameGraph& graph, Stages& stages, const TexturePicture& picture,
                                    std::optional<graph::ImageId> depth_m) {
    BlendPictureInputs inputs;
    inputs.color = add_convert_color(graph, picture.color);
    inputs.gain = picture.gain;
    inputs.voxel_m = stages.settings.map.voxel_m;
    const PosedCamera camera = make_posed_camera(picture.color.camera, picture.world_from_camera);
    inputs.camera = camera.gpu;
    const PosedCamera cast = resized(camera, cast_extent(picture.color.camera.extent));
    const GeometryStage& geometry = stages.geometry;
    const VoxelMapIds voxels = geometry.map().import(graph);
    const VisibleBlocks visible = geometry.add_visible_to_view(graph, voxels, cast);
    const RaycastImages model =
        geometry.add_sharpened(graph, geometry.add_raycast(graph, voxels, visible), cast.intrinsics);
    inputs.depth_m = add_cast_depth(graph, model.position_m, depth_m);
    if (stages.reflectance) {
        const PredictedImages seen = stages.reflectance->add_predict_picture(graph, voxels, visible, model);
        inputs.reflected = {seen.kd, seen.rgb, seen.light};
    }
    return inputs;
}

}  // namespace patina
