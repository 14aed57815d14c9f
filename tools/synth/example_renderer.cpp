#include "tools/synth/example_renderer.h"

#include <numeric>

#include "engine/core/error.h"
#include "passes/observation/observation_params.h"
#include "passes/specular/hemi_images.h"
#include "passes/state/record_list.h"
#include "spirv/shaders.h"

namespace patina::tools {

/// The scenes' buffers on the device.
struct ExampleRenderer::Inputs {
    graph::BufferId scenes, lamps, windows, materials, voxels, views;

    void bind(graph::PassBuilder& pass) const {
        pass.read("Scenes", scenes).read("Lamps", lamps).read("Windows", windows);
        pass.read("Materials", materials).read("Voxels", voxels).read("Views", views);
    }
};

/// What cameras see of them.
struct ExampleRenderer::Shaded {
    graph::BufferId readings, exposures;
};

namespace {

/// One member of all scenes, side by side.
template <class Value, class Member>
graph::BufferId upload_all(graph::FrameGraph& frame, const char* name, std::span<const scenes::ExampleScene> scenes,
                           Member member) {
    std::vector<Value> all;
    for (const scenes::ExampleScene& scene : scenes) {
        const auto& values = scene.*member;
        all.insert(all.end(), values.begin(), values.end());
    }
    return frame.upload<Value>(name, all);
}

graph::BufferId upload_scenes(graph::FrameGraph& frame, std::span<const scenes::ExampleScene> scenes) {
    std::vector<gpu::ExampleScene> all;
    for (const scenes::ExampleScene& scene : scenes) all.push_back(scene.scene);
    return frame.upload<gpu::ExampleScene>("example.scenes", all);
}

/// What counts as an observation: as the pipeline has it by default.
gpu::ObservationParams observation_params(const ObservationMap& map) {
    return make_observation_params(map, ObservationSettings{}, gpu::Camera{}, gpu::Camera{}, 0);
}

}  // namespace

ExampleRenderer::ExampleRenderer(vulkan::Device& device, uint32_t capacity, HemisphereMap map, bool keep_readings)
    : capacity_(capacity),
      hemisphere_map_(map),
      keep_readings_(keep_readings),
      map_(device, {.capacity_blocks = 64, .capacity_records = capacity * gpu::kExampleVoxels}),
      samples_(device, capacity + 1),
      runner_(device) {
    graph::FrameGraph frame = runner_.begin();
    map_.reset(frame, glm::dvec3(0));
    runner_.submit(std::move(frame));
    keep_all_voxels();
}

void ExampleRenderer::keep_all_voxels() {
    static_assert(gpu::kExampleVoxels <= gpu::kSegmentSamples);
    std::vector<gpu::SegmentSampleCount> counts(capacity_ + 1);
    std::vector<uint32_t> kept(size_t{capacity_ + 1} * gpu::kSegmentSamples);
    for (uint32_t label = 1; label <= capacity_; ++label) {
        counts[label].kept = counts[label].eligible = gpu::kExampleVoxels;
        const auto first = kept.begin() + static_cast<ptrdiff_t>(label) * gpu::kSegmentSamples;
        std::iota(first, first + gpu::kExampleVoxels, (label - 1) * gpu::kExampleVoxels);
    }
    graph::FrameGraph frame = runner_.begin();
    SegmentSampleIds ids = samples_.import(frame);
    ids.counts = frame.upload_bytes(ids.counts, 0, std::as_bytes(std::span(counts)), true);
    ids.kept = frame.upload_bytes(ids.kept, 0, std::as_bytes(std::span(kept)), true);
    SegmentSamples::keep(frame, ids);
    runner_.submit(std::move(frame));
}

ExampleRenderer::Shaded ExampleRenderer::add_shade(graph::FrameGraph& frame, const Inputs& inputs,
                                                   const gpu::ExampleParams& params, ObservationMapIds& ids) {
    const uint32_t voxels = params.scenes * gpu::kExampleVoxels;
    const uint32_t groups = (voxels + gpu::kExampleGroup - 1) / gpu::kExampleGroup;
    auto start = frame.compute("scenes.start_examples", spirv::start_examples);
    inputs.bind(start);
    const graph::BufferId irradiance = start.create("Irradiance", voxels * sizeof(glm::vec4));
    ids.records = start.modify("Records", ids.records);
    start.push(params).dispatch(groups);

    auto expose = frame.compute("scenes.expose_examples", spirv::expose_examples);
    inputs.bind(expose);
    expose.read("Irradiance", irradiance).push(params);
    const graph::BufferId exposures = expose.create("Exposures", params.scenes * sizeof(float));
    expose.dispatch(params.scenes);

    auto shade = frame.compute("scenes.shade_examples", spirv::shade_examples);
    inputs.bind(shade);
    shade.read("Irradiance", irradiance).read("Exposures", exposures).push(params);
    const graph::BufferId readings =
        shade.create("Readings", uint64_t{gpu::kExampleViews} * voxels * sizeof(gpu::ExampleReading));
    shade.dispatch(groups, gpu::kExampleViews);
    return {readings, exposures};
}

void ExampleRenderer::add_insert(graph::FrameGraph& frame, graph::BufferId readings, uint32_t scenes, uint32_t view,
                                 ObservationMapIds& ids) {
    const uint32_t voxels = scenes * gpu::kExampleVoxels;
    RecordList stale = create_record_list(frame, "example.stale", voxels);
    auto insert = frame.compute("scenes.insert_examples", spirv::insert_examples);
    insert.read("Readings", readings).specialise("kVoxelChunks", map_.chunks());
    ids.records = insert.modify("Records", ids.records);
    stale.list = insert.modify("Stale", stale.list);
    stale.arguments = insert.modify("StaleArguments", stale.arguments);
    ids.directions = insert.modify("Directions", ids.directions);
    ids.colors = insert.modify("Colors", ids.colors);
    insert.push(
        gpu::InsertExamplesParams{scenes, view, map_.grid().chunk_shift, observation_params(map_).merge_distance2});
    insert.dispatch_covering(voxels);

    auto closest = frame.compute("observation.find_closest_pair", spirv::find_closest_pair);
    closest.read("Stale", stale.list).push(map_.grid()).specialise("kVoxelChunks", map_.chunks());
    ids.directions = closest.modify("Directions", ids.directions);
    closest.dispatch_indirect(stale.arguments);
}

RenderedExamples ExampleRenderer::submit(uint64_t seed, uint64_t first, std::span<const scenes::ExampleScene> scenes) {
    PATINA_ASSERT(!scenes.empty() && scenes.size() <= capacity_, scenes.size(), " scenes for ", capacity_);
    const auto count = static_cast<uint32_t>(scenes.size());
    graph::FrameGraph frame = runner_.begin();
    using Scene = scenes::ExampleScene;
    const Inputs inputs{upload_scenes(frame, scenes),
                        upload_all<gpu::PointLight>(frame, "example.lamps", scenes, &Scene::lamps),
                        upload_all<gpu::ExampleWindow>(frame, "example.windows", scenes, &Scene::windows),
                        upload_all<gpu::WardMaterial>(frame, "example.materials", scenes, &Scene::materials),
                        upload_all<gpu::ExampleVoxel>(frame, "example.voxels", scenes, &Scene::voxels),
                        upload_all<glm::vec4>(frame, "example.views", scenes, &Scene::views)};
    gpu::ExampleParams params{};
    params.seed = {static_cast<uint32_t>(seed), static_cast<uint32_t>(seed >> 32)};
    params.first = static_cast<uint32_t>(first);
    params.scenes = count;
    params.min_cosine = observation_params(map_).min_cosine;
    ObservationMapIds ids = map_.import(frame);
    const Shaded shaded = add_shade(frame, inputs, params, ids);
    for (uint32_t view = 0; view < gpu::kExampleViews; ++view) add_insert(frame, shaded.readings, count, view, ids);

    std::vector<uint32_t> list(1 + count);
    std::iota(list.begin(), list.end(), 0u);
    list[0] = count;
    const SegmentBatch batch{frame.upload<uint32_t>("example.batch", list), count};
    const HemiImages images = add_hemi_images(frame, map_, ids, samples_, samples_.import(frame), batch,
                                              hemisphere_map_, params.seed.x ^ params.first * 0x9e3779b9u);
    auto pack = frame.compute("scenes.pack_examples", spirv::pack_examples);
    pack.read("Images", images.images).push(params);
    const uint32_t words = count * gpu::kExampleHalves / 2;
    const graph::BufferId halves = pack.create("Halves", uint64_t{words} * sizeof(uint32_t));
    pack.dispatch_covering(words);
    RenderedExamples rendered{frame.read_back(halves), frame.read_back(images.drawn)};
    if (keep_readings_) {
        rendered.readings = frame.read_back(shaded.readings);
        rendered.exposures = frame.read_back(shaded.exposures);
    }
    runner_.submit(std::move(frame));
    return rendered;
}

}  // namespace patina::tools
