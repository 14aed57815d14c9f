#include "scenes/render/gather_light.h"

#include <algorithm>

#include "engine/core/error.h"
#include "engine/core/shader_camera.h"
#include "shared/scenes/gather_light.h"
#include "spirv/shaders.h"

namespace patina::scenes {

bool samples_direct_light(const SceneModel& scene, const RenderSettings& settings) {
    return settings.area_lights && scene.has_area_lights();
}

void add_gather_light(graph::FrameGraph& frame, const SceneModel& scene, const Intrinsics& camera,
                      const RigidTransform& world_from_camera, const RenderSettings& settings, uint32_t frame_index,
                      RenderedImages& images) {
    const bool direct = samples_direct_light(scene, settings);
    if (!direct && settings.bounces == 0 && !scene.has_environment()) return;
    if (settings.samples == 0) throw Error("the pass 'scenes.gather_light' needs at least 1 sample per pixel, not 0");
    gpu::GatherLightParams params{
        .camera = make_camera(camera, world_from_camera),
        .seed = {static_cast<uint32_t>(settings.seed), static_cast<uint32_t>(settings.seed >> 32)},
        .frame_index = frame_index,
        .first_sample = 0,
        .sample_count = 0,
        .samples = settings.samples,
        .bounces = settings.bounces,
        .pad0 = 0};
    for (; params.first_sample < params.samples; params.first_sample += params.sample_count) {
        params.sample_count = std::min(gpu::kGatherLightSamples, params.samples - params.first_sample);
        auto pass = frame.compute("scenes.gather_light", spirv::gather_light);
        scene.bind_geometry(frame, pass);
        scene.bind_surfaces(frame, pass);
        scene.bind_environment(frame, pass);
        pass.read("depth_m", images.depth_m).read("object_id", images.object_id).read("normal", images.normal);
        pass.read("kd", images.kd).read("ks_alpha", images.ks_alpha).read("Lifted", images.lifted_m);
        images.radiance = pass.modify("radiance", images.radiance);
        pass.specialise("kShadows", settings.shadows ? 1 : 0).specialise("kDirect", direct ? 1 : 0);
        pass.specialise("kEnvironment", scene.has_environment() ? 1 : 0);
        pass.push(params).dispatch_covering(camera.extent);
    }
}

}  // namespace patina::scenes
