#include "reconstruction/lights/surface_samples.h"

#include <algorithm>
#include <functional>
#include <numbers>
#include <utility>

#include "engine/core/error.h"
#include "engine/core/seed.h"
#include "passes/lighting/sample_surface.h"
#include "passes/reflectance/mark_blocks.h"

namespace patina {

std::vector<gpu::LightSample> draw_samples(Pipeline& pipeline) {
    const ReflectanceStage* reflectance = pipeline.reflectance();
    if (!reflectance) throw Error("lights cannot be found in a reconstruction without reflectance");
    pipeline.wait();
    graph::FrameGraph frame = pipeline.runner().begin();
    const ObservationMap& map = reflectance->observations();
    const uint32_t seed = seed_of_draw(0, pipeline.settings().seed);
    const graph::Readback samples =
        frame.read_back(add_sample_surface(frame, map, map.import(frame), reflectance->import_status(frame), seed));
    pipeline.runner().submit(std::move(frame));
    pipeline.wait();
    return samples.as<gpu::LightSample>();
}

namespace {

/// A pass takes whole groups.
std::vector<gpu::LightSample> in_groups(std::span<const gpu::LightSample> samples) {
    std::vector<gpu::LightSample> padded(samples.begin(), samples.end());
    padded.resize((samples.size() + gpu::kTrialSamples - 1) / gpu::kTrialSamples * gpu::kTrialSamples);
    return padded;
}

/// Adds some of the trials to a frame: what rays are marched through, the samples, how many they are, the trials.
using AddTrials = std::function<graph::BufferId(graph::FrameGraph&, const TrialMap&, graph::BufferId, uint32_t,
                                                std::span<const glm::vec3>)>;

std::vector<float> run_trials(Pipeline& pipeline, std::span<const gpu::LightSample> samples,
                              std::span<const glm::vec3> trials, const AddTrials& add) {
    std::vector<float> rows;
    if (samples.empty()) return rows;
    rows.reserve(samples.size() * trials.size());
    const std::vector<gpu::LightSample> padded = in_groups(samples);
    while (!trials.empty()) {
        const auto batch = trials.first(std::min<size_t>(gpu::kTrialLights, trials.size()));
        trials = trials.subspan(batch.size());
        graph::FrameGraph frame = pipeline.runner().begin();
        const auto uploaded = frame.upload<gpu::LightSample>("lighting.samples", padded);
        const VoxelMap& map = pipeline.map();
        const VoxelMapIds voxels = map.import(frame);
        ReflectanceStateIds around;
        around.surroundings = pipeline.reflectance()->import_surroundings(frame);
        add_mark_blocks(frame, around, map, voxels);
        frame.keep(around.surroundings);
        const TrialMap model{map, voxels, around.surroundings};
        const graph::Readback received =
            frame.read_back(add(frame, model, uploaded, static_cast<uint32_t>(padded.size()), batch));
        pipeline.runner().submit(std::move(frame));
        pipeline.wait();
        const auto tried = received.as<float>();
        for (size_t i = 0; i < batch.size(); ++i) {
            const auto row = tried.begin() + static_cast<ptrdiff_t>(i * gpu::kLightSamples);
            rows.insert(rows.end(), row, row + static_cast<ptrdiff_t>(samples.size()));
        }
    }
    return rows;
}

}  // namespace

std::vector<float> try_lamps(Pipeline& pipeline, std::span<const gpu::LightSample> samples,
                             std::span<const glm::vec3> places_m) {
    return run_trials(
        pipeline, samples, places_m,
        [](graph::FrameGraph& frame, const TrialMap& model, graph::BufferId uploaded, uint32_t count,
           std::span<const glm::vec3> batch) { return add_try_lights(frame, model, uploaded, batch, count); });
}

std::vector<float> try_suns(Pipeline& pipeline, std::span<const gpu::LightSample> samples,
                            std::span<const glm::vec3> directions, glm::vec4 ball_m) {
    return run_trials(
        pipeline, samples, directions,
        [&](graph::FrameGraph& frame, const TrialMap& model, graph::BufferId uploaded, uint32_t count,
            std::span<const glm::vec3> batch) { return add_try_suns(frame, model, uploaded, batch, count, ball_m); });
}

glm::vec4 ball_around(std::span<const gpu::LightSample> samples) {
    constexpr float kMargin_m = 0.5f;  // there may be surface between samples, too
    glm::vec3 low(1e9f), high(-1e9f);
    for (const gpu::LightSample& sample : samples) {
        if (sample.point_m.w <= 0) continue;
        low = glm::min(low, glm::vec3(sample.point_m));
        high = glm::max(high, glm::vec3(sample.point_m));
    }
    return low.x > high.x ? glm::vec4(0) : glm::vec4(0.5f * (low + high), 0.5f * glm::distance(low, high) + kMargin_m);
}

std::vector<glm::vec3> received_from(Pipeline& pipeline, std::span<const gpu::LightSample> samples,
                                     std::span<const Light> lights) {
    std::vector<glm::vec3> places_m, directions, of_suns;
    std::vector<Light> lamps;
    for (const Light& light : lights) {
        if (is_sun(light)) {
            directions.emplace_back(glm::normalize(light.position_m));
            of_suns.emplace_back(light.intensity / (glm::dot(light.position_m, light.position_m) * std::numbers::pi));
        } else {
            places_m.emplace_back(light.position_m);
            lamps.push_back(light);
        }
    }
    samples = samples.first(gpu::kLightSamples);
    std::vector<glm::vec3> received(samples.size(), glm::vec3(0));
    const auto add = [&](const std::vector<float>& tried, size_t count, const auto& intensity) {
        for (size_t l = 0; l < count; ++l)
            for (size_t i = 0; i < samples.size(); ++i)
                received[i] += tried[l * samples.size() + i] * intensity(l, glm::dvec3(samples[i].point_m));
    };
    if (!places_m.empty())
        add(try_lamps(pipeline, samples, places_m), lamps.size(),
            [&](size_t lamp, glm::dvec3 point_m) { return glm::vec3(intensity_towards(lamps[lamp], point_m)); });
    if (!directions.empty())
        add(try_suns(pipeline, samples, directions, ball_around(samples)), of_suns.size(),
            [&](size_t sun, glm::dvec3 /*point_m*/) { return of_suns[sun]; });
    return received;
}

}  // namespace patina
