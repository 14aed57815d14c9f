#include "tests/gpu/fusion/fusion_rig.h"

#include <algorithm>

#include <glm/gtc/packing.hpp>

#include "engine/core/shader_camera.h"
#include "passes/fusion/integrate.h"
#include "passes/fusion/measure_slope.h"
#include "passes/fusion/remove_empty_blocks.h"
#include "shared/test/test_voxel_map.h"
#include "spirv/shaders.h"

namespace patina {

namespace {

constexpr float kNearM = 0.1f;

}  // namespace

Image<glm::vec4> widen(const Image<uint64_t>& halves) {
    Image<glm::vec4> wide(halves.extent());
    for (size_t i = 0; i < halves.pixels().size(); ++i) wide.pixels()[i] = glm::unpackHalf4x16(halves.pixels()[i]);
    return wide;
}

reference::BlockCoordinates coordinates_of_key(uint32_t key) {
    return {static_cast<int>(key % 2048) - 1024, static_cast<int>(key / 2048 % 1024) - 512,
            static_cast<int>(key / 2048 / 1024) - 1024};
}

FusionRig::FusionRig(vulkan::Device& device, graph::Runner& runner, const VoxelMapSettings& map,
                     const FusionSettings& fusion)
    : device_(device), runner_(runner), map_(device, map), fusion_(fusion) {
    graph::FrameGraph frame = runner_.begin();
    map_.reset(frame, glm::dvec3(0));
    runner_.submit(std::move(frame));
}

gpu::FusionParams FusionRig::fusion_params(const gpu::Camera& depth_camera, const gpu::Camera& color_camera) const {
    return make_fusion_params(map_, fusion_, depth_camera, color_camera, frame_, color_frame_);
}

void FusionRig::fuse(const Intrinsics& camera, const RigidTransform& world_from_camera, const Image<float>& depth_m,
                     const std::optional<ColorView>& color) {
    graph::FrameGraph frame = runner_.begin();
    const gpu::Camera depth_camera = make_camera(camera, world_from_camera);
    const gpu::FusionParams values =
        fusion_params(depth_camera, color ? make_camera(color->camera, color->world_from_camera) : depth_camera);
    const auto params = frame.upload<gpu::FusionParams>("params", std::span(&values, 1));
    const auto depth =
        frame.upload("depth", {camera.extent, vulkan::Format::kR32f}, std::as_bytes(std::span(depth_m.pixels())));
    std::optional<graph::ImageId> color_id;
    if (color) {
        std::vector<uint64_t> halves;
        for (const glm::vec4& pixel : color->linear.pixels()) halves.push_back(glm::packHalf4x16(pixel));
        color_id =
            frame.upload("color", {color->camera.extent, vulkan::Format::kRgba16f}, std::as_bytes(std::span(halves)));
    }
    VoxelMapIds ids = map_.import(frame);
    add_allocate_blocks(frame, map_, ids, depth, params, fusion_.allocation_stride_px);
    const VisibleBlocks visible = add_visible_blocks(frame, map_, ids, depth_camera, kNearM, far_m());
    const graph::ImageId slope = add_measure_slope(frame, depth, camera);
    add_integrate(frame, map_, ids, visible, params, depth, slope, color_id);
    VoxelMap::keep(frame, ids);
    runner_.submit(std::move(frame));
    ++frame_;
    if (color) ++color_frame_;
}

void FusionRig::remove_empty_blocks(const Intrinsics& camera, const RigidTransform& world_from_camera) {
    graph::FrameGraph frame = runner_.begin();
    const gpu::Camera shader_camera = make_camera(camera, world_from_camera);
    const gpu::FusionParams values = fusion_params(shader_camera, shader_camera);
    const auto params = frame.upload<gpu::FusionParams>("params", std::span(&values, 1));
    VoxelMapIds ids = map_.import(frame);
    const VisibleBlocks visible = add_visible_blocks(frame, map_, ids, shader_camera, kNearM, far_m());
    add_remove_empty_blocks(frame, map_, ids, visible, params);
    VoxelMap::keep(frame, ids);
    runner_.submit(std::move(frame));
}

FusionRig::View FusionRig::raycast(const Intrinsics& camera, const RigidTransform& world_from_camera,
                                   std::optional<MapAccess> access) {
    graph::FrameGraph frame = runner_.begin();
    const VoxelMapIds ids = map_.import(frame);
    const VisibleBlocks visible =
        add_visible_blocks(frame, map_, ids, make_camera(camera, world_from_camera), kNearM, far_m());
    const RaycastImages images =
        add_raycast(frame, map_, ids, visible, access.value_or(preferred_map_access(device_.caps(), map_)));
    const graph::Readback position = frame.read_back(images.position_m);
    const graph::Readback normal = frame.read_back(images.normal);
    runner_.submit(std::move(frame));
    runner_.wait();
    return {position.image<glm::vec4>(), widen(normal.image<uint64_t>())};
}

gpu::MapCounters FusionRig::counters() {
    graph::FrameGraph frame = runner_.begin();
    const graph::Readback read = frame.read_back(map_.import(frame).counters);
    runner_.submit(std::move(frame));
    runner_.wait();
    return read.as<gpu::MapCounters>().front();
}

TableContent FusionRig::table() {
    graph::FrameGraph frame = runner_.begin();
    const VoxelMapIds ids = map_.import(frame);
    const graph::Readback keys = frame.read_back(ids.keys), blocks = frame.read_back(ids.blocks),
                          block_keys = frame.read_back(ids.block_keys), free_list = frame.read_back(ids.free_list),
                          counters = frame.read_back(ids.counters);
    runner_.submit(std::move(frame));
    runner_.wait();
    TableContent table{keys.as<uint32_t>(), blocks.as<uint32_t>(), block_keys.as<uint32_t>(), free_list.as<uint32_t>()};
    table.free_list.resize(counters.as<gpu::MapCounters>().front().free_blocks);
    return table;
}

std::set<reference::BlockCoordinates> FusionRig::allocated() {
    std::set<reference::BlockCoordinates> blocks;
    for (const uint32_t key : table().block_keys) {
        if (key != gpu::kEmptyKey) blocks.insert(coordinates_of_key(key));
    }
    return blocks;
}

MapContent FusionRig::content() {
    const uint32_t count = std::max(counters().high_water, 1u);
    const std::vector<uint32_t> keys = table().block_keys;
    graph::FrameGraph frame = runner_.begin();
    const VoxelMapIds ids = map_.import(frame);
    auto gather = frame.compute("test.gather_blocks", spirv::test_gather_blocks);
    gather.read("Tsdf", ids.tsdf).read("Color", ids.color);
    gather.specialise("kVoxelChunks", map_.chunks());
    const auto tsdf_id = gather.create("GatheredTsdf", count * gpu::kBlockVoxels * sizeof(uint32_t));
    const auto color_id = gather.create("GatheredColor", count * gpu::kBlockVoxels * sizeof(uint32_t));
    gather.push(gpu::TestMapParams{map_.grid(), count, 0, 0, 0});
    gather.dispatch(gpu::kGroupsPerRow, (count + gpu::kGroupsPerRow - 1) / gpu::kGroupsPerRow);
    const graph::Readback tsdf_read = frame.read_back(tsdf_id), color_read = frame.read_back(color_id);
    runner_.submit(std::move(frame));
    runner_.wait();

    const auto tsdf = tsdf_read.as<uint32_t>();
    const auto color = color_read.as<uint32_t>();
    MapContent content;
    for (uint32_t block = 0; block < count; ++block) {
        if (keys[block] == gpu::kEmptyKey) continue;
        const ptrdiff_t first = ptrdiff_t{block} * gpu::kBlockVoxels, last = first + gpu::kBlockVoxels;
        content[coordinates_of_key(keys[block])] = {{tsdf.begin() + first, tsdf.begin() + last},
                                                    {color.begin() + first, color.begin() + last}};
    }
    return content;
}

reference::Volume FusionRig::volume() {
    const double range_m = double{gpu::kSdfRangeVox} * map_.settings().voxel_m;
    reference::Volume volume{map_.settings().voxel_m, {}};
    for (const auto& [coordinates, block] : content()) {
        std::vector<reference::Voxel>& voxels = volume.blocks[coordinates];
        for (size_t i = 0; i < gpu::kBlockVoxels; ++i) {
            const uint32_t color = block.color[i];
            const glm::dvec3 root =
                glm::dvec3(color % 2048, color / 2048 % 2048, color >> 22) / glm::dvec3(2047, 2047, 1023);
            voxels.push_back({static_cast<int16_t>(block.tsdf[i] & 0xffff) / 32767.0 * range_m,
                              static_cast<double>(block.tsdf[i] >> 16), root * root * double{gpu::kColorRange},
                              color != 0});
        }
    }
    return volume;
}

reference::Fusion FusionRig::reference_fusion() const {
    const gpu::FusionParams params = fusion_params({}, {});
    return {params.truncation_m,        params.truncation_slope, params.max_depth_m,      gpu::kWeightOne,
            params.max_weight,          params.color_band_m,     params.max_color_weight, params.settled_weight,
            params.settled_color_every, params.color_frame};
}

}  // namespace patina
