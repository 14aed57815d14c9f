#include "passes/shading/predict_radiance.h"

#include "passes/shading/pack_records.h"
#include "shared/shading/predict_radiance.h"
#include "shared/shading/reflect_surroundings.h"
#include "spirv/shaders.h"

namespace patina {

namespace {

graph::BufferId add_index_records(graph::FrameGraph& frame, const VoxelMap& voxel_map, const VoxelMapIds& voxels,
                                  const ObservationMap& map, const ObservationMapIds& records,
                                  const PredictRadianceInputs& inputs) {
    auto pass = frame.compute("shading.index_records", spirv::index_records);
    pass.read("View", inputs.view).read("ViewGrid", inputs.view_grid);
    pass.read("BlockKeys", voxels.block_keys).read("Counters", voxels.counters);
    pass.read("Keys", records.keys).read("Blocks", records.blocks).read("RecordTable", records.record_table);
    const uint64_t count = uint64_t{voxel_map.capacity()} << 3 * map.edge_shift();
    const graph::BufferId entries = pass.create("Entries", count * sizeof(uint32_t));
    pass.push(gpu::IndexRecordsParams{voxel_map.grid(), map.grid(), map.edge_shift(), 0, 0, 0});
    pass.dispatch_indirect(voxels.block_arguments);
    return entries;
}

}  // namespace

PredictedImages add_predict_radiance(graph::FrameGraph& frame, const VoxelMap& voxel_map, const VoxelMapIds& voxels,
                                     const ObservationMap& map, const ObservationMapIds& records,
                                     const ReflectanceStateIds& state, const PredictRadianceInputs& inputs) {
    const Extent2D extent = frame.common_extent({inputs.position_m, inputs.normal});
    const PackedRecords packed{add_index_records(frame, voxel_map, voxels, map, records, inputs),
                               add_pack_records(frame, map, records, state)};
    const bool texel = inputs.access == MapAccess::kTexel;
    auto pass =
        frame.compute("shading.predict_radiance", texel ? spirv::predict_radiance_texel : spirv::predict_radiance);
    pass.read("position_m", inputs.position_m).read("normal", inputs.normal).read("View", inputs.view);
    pass.read("ViewGrid", inputs.view_grid).read("Entries", packed.entries).read("Packed", packed.content);
    pass.read("Records", records.records).read("Visibility", records.visibility);
    pass.read("Lights", inputs.lights).read("Materials", inputs.materials);
    pass.read("Segments", inputs.segments);
    // A pipeline for each of three classes, not for every number of lights.
    const uint32_t most_lights = inputs.most_lights <= gpu::kFewLights         ? gpu::kFewLights
                                 : inputs.most_lights <= gpu::kLightsOfOneWord ? gpu::kLightsOfOneWord
                                                                               : gpu::kMaxPointLights;
    pass.specialise("kMostLights", most_lights).specialise("kGathers", inputs.gathers ? 1u : 0u);
    pass.specialise("kOfPicture", inputs.of_picture ? 1u : 0u).specialise("kGlossApart", inputs.gloss_apart ? 1u : 0u);
    pass.specialise("kOtherLight", inputs.other_light ? 1u : 0u);
    pass.read("Status", state.status).read("Gathered", state.gathered);
    PredictedImages out;
    out.packed = packed;
    out.glossy = pass.create("Glossy", (inputs.gloss_apart ? uint64_t{extent.area()} : 1u) * sizeof(gpu::GlossyPixel));
    out.kd = pass.create("kd", {extent, vulkan::Format::kRgba16f});
    out.picture_kd = pass.create("picture_kd", {extent, vulkan::Format::kRgba16f});
    out.label = pass.create("label", {extent, vulkan::Format::kR32u});
    out.ks_alpha = pass.create("ks_alpha", {extent, vulkan::Format::kRgba16f});
    out.rgb = pass.create("rgb", {extent, vulkan::Format::kRgba16f});
    out.light = pass.create("light", {extent, vulkan::Format::kRgba16f});
    pass.push(gpu::PredictRadianceParams{map.settings().voxel_m, map.edge_shift(), inputs.material_count,
                                         inputs.shadows ? 1u : 0u});
    pass.dispatch_covering(extent);
    return out;
}

}  // namespace patina
