#include "reconstruction/lights/surface_samples.h"

#include "engine/core/error.h"
#include "engine/core/seed.h"
#include "passes/lighting/sample_surface.h"

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

std::vector<float> try_lamps(Pipeline& pipeline, std::span<const gpu::LightSample> samples,
                             std::span<const glm::vec3> places_m, uint32_t count) {
    graph::FrameGraph frame = pipeline.runner().begin();
    const auto uploaded = frame.upload<gpu::LightSample>("lighting.samples", samples);
    const VoxelMap& map = pipeline.map();
    const graph::Readback received =
        frame.read_back(add_try_lights(frame, map, map.import(frame), uploaded, places_m, count));
    pipeline.runner().submit(std::move(frame));
    pipeline.wait();
    return received.as<float>();
}

}  // namespace patina
