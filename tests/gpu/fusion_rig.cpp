#include "tests/gpu/fusion_rig.h"

#include <glm/gtc/packing.hpp>

#include "passes/fusion/integrate.h"
#include "passes/fusion/measure_slope.h"
#include "passes/model/camera.h"

namespace patina {

namespace {

constexpr float kNearM = 0.1f;

/// Four half floats per pixel to four floats.
Image<glm::vec4> widen(const Image<uint64_t>& halves) {
    Image<glm::vec4> wide(halves.extent());
    for (size_t i = 0; i < halves.pixels().size(); ++i) wide.pixels()[i] = glm::unpackHalf4x16(halves.pixels()[i]);
    return wide;
}

}  // namespace

FusionRig::FusionRig(vulkan::Device& device, graph::Runner& runner, const VoxelMapSettings& map,
                     const FusionSettings& fusion)
    : device_(device), runner_(runner), map_(device, map), fusion_(fusion) {
    graph::Frame frame = runner_.begin();
    map_.reset(frame, glm::dvec3(0));
    runner_.submit(std::move(frame));
}

void FusionRig::fuse(const Intrinsics& camera, const RigidTransform& world_from_camera, const Image<float>& depth_m,
                     const Image<glm::vec4>* color) {
    graph::Frame frame = runner_.begin();
    const gpu::Camera shader_camera = make_camera(camera, world_from_camera);
    const gpu::FusionParams values = make_fusion_params(map_, fusion_, shader_camera, shader_camera, frame_++);
    const auto params = frame.upload<gpu::FusionParams>("params", std::span(&values, 1));
    const auto depth =
        frame.upload("depth", {camera.extent, vulkan::Format::kR32f}, std::as_bytes(std::span(depth_m.pixels())));
    std::optional<graph::ImageId> color_id;
    if (color) {
        std::vector<uint64_t> halves;
        for (const glm::vec4& pixel : color->pixels()) halves.push_back(glm::packHalf4x16(pixel));
        color_id = frame.upload("color", {camera.extent, vulkan::Format::kRgba16f}, std::as_bytes(std::span(halves)));
    }
    VoxelMapIds ids = map_.import(frame);
    add_allocate_blocks(frame, map_, ids, depth, params, fusion_.allocation_stride_px);
    const VisibleBlocks visible =
        add_visible_blocks(frame, map_, ids, shader_camera, kNearM, fusion_.max_depth_m + 0.1f);
    const graph::ImageId slope = add_measure_slope(frame, depth, camera);
    add_integrate(frame, map_, ids, visible, params, depth, slope, color_id);
    VoxelMap::keep(frame, ids);
    runner_.submit(std::move(frame));
}

FusionRig::View FusionRig::raycast(const Intrinsics& camera, const RigidTransform& world_from_camera,
                                   std::optional<MapAccess> access) {
    graph::Frame frame = runner_.begin();
    const VoxelMapIds ids = map_.import(frame);
    const VisibleBlocks visible = add_visible_blocks(frame, map_, ids, make_camera(camera, world_from_camera), kNearM,
                                                     fusion_.max_depth_m + 0.1f);
    const RaycastImages images =
        add_raycast(frame, map_, ids, visible, access.value_or(preferred_map_access(device_.caps(), map_)));
    const graph::Readback position = frame.read_back(images.position_m);
    const graph::Readback normal = frame.read_back(images.normal);
    runner_.submit(std::move(frame));
    runner_.wait();
    return {position.image<glm::vec4>(), widen(normal.image<uint64_t>())};
}

gpu::MapCounters FusionRig::counters() {
    graph::Frame frame = runner_.begin();
    const graph::Readback read = frame.read_back(map_.import(frame).counters);
    runner_.submit(std::move(frame));
    runner_.wait();
    return read.as<gpu::MapCounters>().front();
}

}  // namespace patina
