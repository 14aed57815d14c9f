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

struct TriedSamples {
    graph::BufferId samples;
    uint32_t count = 0;  // of them that are tried
};

graph::BufferId add_trials(graph::FrameGraph& frame, graph::PassBuilder& pass, const TrialMap& model,
                           const TriedSamples& tried, std::span<const glm::vec3> lights, glm::vec4 ball_m) {
    if (lights.empty() || lights.size() > gpu::kTrialLights)
        throw Error("1 to ", gpu::kTrialLights, " lights are tried at once, not ", lights.size());
    if (tried.count > gpu::kLightSamples || tried.count % gpu::kTrialSamples != 0)
        throw Error("lights are tried with whole groups of ", gpu::kTrialSamples, " of ", gpu::kLightSamples,
                    " samples, not with ", tried.count);
    const auto trials = static_cast<uint32_t>(lights.size());
    std::vector<glm::vec4> padded;
    for (const glm::vec3& light : lights) padded.emplace_back(light, 0);
    pass.read("Samples", tried.samples).read("Trials", frame.upload<glm::vec4>("lighting.trials", padded));
    pass.read("Keys", model.voxels.keys).read("Blocks", model.voxels.blocks).read("Tsdf", model.voxels.tsdf);
    pass.read("Surroundings", model.surroundings);
    pass.specialise("kVoxelChunks", model.map.chunks());
    pass.push(gpu::TrialParams{model.map.grid(), ball_m, trials, 0, 0, 0});
    const graph::BufferId received = pass.create("Received", uint64_t{trials} * gpu::kLightSamples * sizeof(float));
    pass.dispatch((trials + gpu::kTrialGroup - 1) / gpu::kTrialGroup, tried.count / gpu::kTrialSamples);
    return received;
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

graph::BufferId add_try_lights(graph::FrameGraph& frame, const TrialMap& model, graph::BufferId samples,
                               std::span<const glm::vec3> places_m, uint32_t count) {
    auto pass = frame.compute("lighting.try_lights", spirv::try_lights);
    return add_trials(frame, pass, model, {samples, count}, places_m, glm::vec4(0));
}

graph::BufferId add_try_suns(graph::FrameGraph& frame, const TrialMap& model, graph::BufferId samples,
                             std::span<const glm::vec3> directions, uint32_t count, glm::vec4 ball_m) {
    auto pass = frame.compute("lighting.try_suns", spirv::try_suns);
    return add_trials(frame, pass, model, {samples, count}, directions, ball_m);
}

}  // namespace patina
