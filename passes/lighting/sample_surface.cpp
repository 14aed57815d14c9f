#include "passes/lighting/sample_surface.h"

#include <vector>

#include "engine/core/error.h"
#include "spirv/shaders.h"

namespace patina {
namespace {

void bind_records(graph::PassBuilder& pass, const ObservationMap& map, const ObservationMapIds& ids, uint32_t seed) {
    pass.read("RecordCounters", ids.record_counters).read("Records", ids.records);
    pass.read("Directions", ids.directions).read("Colors", ids.colors);
    pass.specialise("kVoxelChunks", map.chunks());
    pass.push(gpu::SampleParams{map.grid(), map.edge_shift(), seed, 0, 0});
}

}  // namespace

graph::BufferId add_sample_surface(graph::FrameGraph& frame, const ObservationMap& map,
                                   const ObservationMapIds& records, graph::BufferId status, uint32_t seed) {
    constexpr uint64_t kPlaces = 2 * gpu::kLightSamples;
    const graph::BufferId unclaimed = frame.fill(frame.create_buffer("lighting.claims", kPlaces * sizeof(uint32_t)), 0);
    auto claim = frame.compute("lighting.claim_samples", spirv::claim_samples);
    bind_records(claim, map, records, seed);
    const graph::BufferId claims = claim.modify("Claims", unclaimed);
    claim.dispatch_covering(map.capacity_records());

    const graph::BufferId none =
        frame.fill(frame.create_buffer("lighting.samples", kPlaces * sizeof(gpu::LightSample)), 0);
    auto draw = frame.compute("lighting.draw_samples", spirv::draw_samples);
    bind_records(draw, map, records, seed);
    draw.read("Claims", claims).read("Status", status);
    const graph::BufferId samples = draw.modify("Samples", none);
    draw.dispatch_covering(map.capacity_records());
    return samples;
}

graph::BufferId add_try_lights(graph::FrameGraph& frame, const VoxelMap& map, const VoxelMapIds& voxels,
                               graph::BufferId samples, std::span<const glm::vec3> places_m, uint32_t count,
                               glm::vec4 ball_m) {
    if (places_m.empty() || places_m.size() > gpu::kTrialLights) {
        throw Error("the pass 'lighting.try_lights' tries 1 to ", gpu::kTrialLights, " lights at once, not ",
                    places_m.size());
    }
    const auto trials = static_cast<uint32_t>(places_m.size());
    std::vector<glm::vec4> padded;
    for (const glm::vec3& place_m : places_m) padded.emplace_back(place_m, 0);
    auto pass = frame.compute("lighting.try_lights", spirv::try_lights);
    pass.read("Samples", samples).read("Trials", frame.upload<glm::vec4>("lighting.trials", padded));
    pass.read("Keys", voxels.keys).read("Blocks", voxels.blocks).read("Tsdf", voxels.tsdf);
    pass.specialise("kVoxelChunks", map.chunks());
    pass.push(gpu::TrialParams{map.grid(), ball_m});
    const graph::BufferId received = pass.create("Received", uint64_t{trials} * gpu::kLightSamples * sizeof(float));
    pass.dispatch(count / gpu::kRecordGroup, trials);
    return received;
}

graph::BufferId add_try_suns(graph::FrameGraph& frame, const VoxelMap& map, const VoxelMapIds& voxels,
                             graph::BufferId surroundings, graph::BufferId samples,
                             std::span<const glm::vec3> directions, uint32_t count, glm::vec4 ball_m) {
    if (directions.empty() || directions.size() > gpu::kTrialLights) {
        throw Error("the pass 'lighting.try_suns' tries 1 to ", gpu::kTrialLights, " suns at once, not ",
                    directions.size());
    }
    const auto trials = static_cast<uint32_t>(directions.size());
    std::vector<glm::vec4> padded;
    for (const glm::vec3& direction : directions) padded.emplace_back(direction, 0);
    auto pass = frame.compute("lighting.try_suns", spirv::try_suns);
    pass.read("Samples", samples).read("Trials", frame.upload<glm::vec4>("lighting.trials", padded));
    pass.read("Surroundings", surroundings);
    pass.read("Keys", voxels.keys).read("Blocks", voxels.blocks).read("Tsdf", voxels.tsdf);
    pass.specialise("kVoxelChunks", map.chunks());
    pass.push(gpu::TrialParams{map.grid(), ball_m});
    const graph::BufferId received = pass.create("Received", uint64_t{trials} * gpu::kLightSamples * sizeof(float));
    pass.dispatch(count / gpu::kRecordGroup, trials);
    return received;
}

}  // namespace patina
