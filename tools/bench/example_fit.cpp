#include "tools/bench/example_fit.h"

#include <algorithm>
#include <set>

#include "engine/core/error.h"
#include "engine/core/shader_light.h"
#include "passes/specular/fit_ward.h"
#include "tools/bench/filled_records.h"

namespace patina {

namespace {

constexpr uint32_t kVoxels = gpu::kExampleVoxels;

Lights lights_of(const scenes::ExampleScene& scene, float exposure) {
    std::vector<Light> lamps;
    for (size_t i = 0; i < scene.scene.lamps; ++i) {
        lamps.push_back(light_of(scene.lamps[i]));
        lamps.back().intensity *= exposure;
    }
    Lights lights;
    lights.set(lamps);
    return lights;
}

/// lib/records/reflectance.glsl: is_marched().
gpu::RecordStatus marched_with(const Lights& lights) {
    gpu::RecordStatus status{};
    status.marched = (lights.position_version() % 255 + 1) << 24;
    return status;
}

glm::uvec2 reached_by(const scenes::ExampleScene& scene, const gpu::ExampleVoxel& voxel) {
    return {~voxel.shadow & ((1u << scene.scene.lamps) - 1), 0};
}

std::vector<FilledObservation> observations_of(const ExampleBatch& batch, size_t voxel) {
    std::vector<gpu::ExampleReading> seen;
    const size_t voxels = batch.scenes.size() * kVoxels;
    for (size_t view = 0; view < gpu::kExampleViews; ++view) {
        const gpu::ExampleReading& reading = batch.readings[view * voxels + voxel];
        if (reading.to_viewer.w != 0) seen.push_back(reading);
    }
    const size_t count = std::min<size_t>(seen.size(), gpu::kMaxObservations);
    std::vector<FilledObservation> observations;
    for (size_t i = 0; i < count; ++i) {
        const gpu::ExampleReading& reading = seen[i * seen.size() / count];
        const auto clipped = static_cast<uint32_t>(reading.rgb.w);
        observations.push_back({glm::vec3(reading.to_viewer),
                                glm::vec3(reading.rgb),
                                {(clipped & 1) != 0, (clipped & 2) != 0, (clipped & 4) != 0}});
    }
    return observations;
}

}  // namespace

ExampleBatch render_examples(tools::ExampleRenderer& renderer, uint64_t seed, uint64_t first,
                             std::vector<scenes::ExampleScene> scenes) {
    const tools::RenderedExamples rendered = renderer.submit(seed, first, scenes);
    renderer.wait();
    return {std::move(scenes), rendered.halves.as<uint16_t>(), rendered.drawn.as<uint32_t>(),
            rendered.readings.as<gpu::ExampleReading>(), rendered.exposures.as<float>()};
}

ExampleFit::ExampleFit(vulkan::Device& device, uint32_t capacity)
    : capacity_(capacity),
      map_(device,
           {.voxel_m = 0.005f, .block_m = 0.01f, .capacity_blocks = 64, .capacity_records = capacity * kVoxels}),
      samples_(device, capacity),
      table_(device, capacity),
      runner_(device) {}

void ExampleFit::fill(const ExampleBatch& batch) {
    graph::FrameGraph frame = runner_.begin();
    map_.reset(frame, glm::dvec3(0));
    table_.reset(frame);
    runner_.submit(std::move(frame));

    std::vector<FilledRecord> records;
    std::vector<glm::uvec2> reached;
    std::vector<std::vector<uint32_t>> kept(capacity_);
    lights_.clear();
    status_.clear();
    for (uint32_t scene = 0; scene < batch.scenes.size(); ++scene) {
        lights_.push_back(lights_of(batch.scenes[scene], batch.exposures[scene]));
        std::set<std::pair<uint32_t, uint32_t>> places;
        for (const gpu::ExampleVoxel& voxel : batch.scenes[scene].voxels) {
            const auto record = static_cast<uint32_t>(records.size());
            records.push_back(
                {glm::vec3(voxel.point_m), glm::vec3(voxel.stored_normal), scene, observations_of(batch, record)});
            reached.push_back(reached_by(batch.scenes[scene], voxel));
            status_.push_back(marched_with(lights_.back()));
            const FilledPlace place = place_of(map_, records.back());
            if (places.emplace(place.block_key, place.voxel).second) kept[scene].push_back(record);
        }
    }
    frame = runner_.begin();
    ObservationMapIds ids = map_.import(frame);
    add_fill_records(frame, map_, ids, records);
    ids.visibility = frame.upload_bytes(ids.visibility, 0, std::as_bytes(std::span(reached)), false);
    ObservationMap::keep(frame, ids);
    add_keep_records(frame, samples_, kept);
    runner_.submit(std::move(frame));
}

std::vector<gpu::WardFit> ExampleFit::fit_once(const ExampleBatch& batch, const std::vector<gpu::WardMaterial>& said) {
    graph::FrameGraph frame = runner_.begin();
    const ObservationMapIds records = map_.import(frame);
    const SegmentSampleIds samples = samples_.import(frame);
    const graph::BufferId status = frame.upload<gpu::RecordStatus>("examples.status", status_);
    const graph::BufferId network = frame.upload<gpu::WardMaterial>("examples.network", said);
    graph::BufferId materials =
        frame.upload<gpu::SegmentMaterial>("examples.materials", std::vector<gpu::SegmentMaterial>(capacity_));
    WardFitIds ids = table_.import(frame);
    for (uint32_t scene = 0; scene < batch.scenes.size(); ++scene) {
        if (!batch.is_lit_by_lamps(scene)) continue;
        const Lights& lights = lights_[scene];
        const FitWardInputs inputs{
            map_,    records, status,   lights.upload(frame), lights.position_version(), samples_,
            samples, network, capacity_};
        const SegmentBatch one{frame.upload<uint32_t>("examples.label", std::vector<uint32_t>{1, scene}), 1};
        add_fit_ward(frame, inputs, one, table_, ids, materials);
    }
    WardFits::keep(frame, ids);
    const graph::Readback fits = frame.read_back(ids.fits);
    runner_.submit(std::move(frame));
    runner_.wait();
    return fits.as<gpu::WardFit>();
}

std::vector<gpu::WardFit> ExampleFit::fit(const ExampleBatch& batch, std::span<const WardParameters> network,
                                          uint32_t fits) {
    PATINA_ASSERT(batch.scenes.size() <= capacity_, batch.scenes.size(), " scenes for ", capacity_);
    fill(batch);
    std::vector<gpu::WardMaterial> said(capacity_);
    for (size_t i = 0; i < network.size(); ++i) {
        said[i] = {glm::vec4(network[i].kd, 1), glm::vec4(network[i].ks, network[i].alpha)};
    }
    std::vector<gpu::WardFit> result;
    for (uint32_t i = 0; i < fits; ++i) result = fit_once(batch, said);
    return result;
}

}  // namespace patina
