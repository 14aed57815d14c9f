#include "passes/reflectance/surface_albedo.h"

#include "shared/reflectance/surface_albedo.h"
#include "spirv/shaders.h"

namespace patina {

namespace {

// The dispatch covers the pool, used or not, and software devices run a group that finds nothing at nearly full cost.
constexpr uint32_t kAlbedosPerItem = 8;
constexpr uint64_t kTableBytes = sizeof(glm::uvec4) + gpu::kSurfaceCells * sizeof(gpu::SurfaceCell);

}  // namespace

void add_surface_albedo(graph::FrameGraph& frame, const ObservationMap& map, const ObservationMapIds& records,
                        ReflectanceStateIds& state, graph::BufferId lights, const glm::vec4& cube_m) {
    const gpu::SurfaceAlbedoParams params{map.grid(), map.edge_shift(), 0, 0, 0, cube_m};
    const auto add = [&](graph::PassBuilder& pass) {
        pass.read("RecordCounters", records.record_counters).read("Records", records.records);
        pass.read("Albedo", records.albedo).read("Visibility", records.visibility);
        pass.read("Lights", lights).read("Status", state.status);
        pass.specialise("kRecordsPerItem", kAlbedosPerItem).push(params);
        pass.dispatch_covering((map.capacity_records() + kAlbedosPerItem - 1) / kAlbedosPerItem);
    };
    graph::BufferId surfaces = frame.fill(frame.create_buffer("reflectance.surfaces", kTableBytes), 0);
    auto sum = frame.compute("reflectance.sum_surfaces", spirv::sum_surfaces);
    surfaces = sum.modify("Surfaces", surfaces);
    add(sum);
    auto look = frame.compute("reflectance.look_up_surfaces", spirv::look_up_surfaces);
    state.gathered = look.read("Surfaces", surfaces).modify("Gathered", state.gathered);
    add(look);
}

}  // namespace patina
