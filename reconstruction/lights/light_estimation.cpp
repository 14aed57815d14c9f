#include "reconstruction/lights/light_estimation.h"

#include <algorithm>

#include "engine/core/error.h"
#include "engine/core/shader_camera.h"
#include "passes/input/convert_color.h"
#include "passes/input/convert_depth.h"

namespace patina {
namespace {

const LightEstimationSettings& checked(const LightEstimationSettings& settings) {
    const auto check_positive = [](const char* name, float value) {
        if (!(value > 0)) throw Error(name, " is ", value, ", it must be above 0");
    };
    check_positive("lights.threshold", settings.find.threshold);
    check_positive("lights.bandwidth_m", settings.find.bandwidth_m);
    check_positive("lights.bandwidth_rad", settings.find.bandwidth_rad);
    check_positive("lights.match_m", settings.find.match_m);
    check_positive("lights.match_rad", settings.find.match_rad);
    return settings;
}

FoundLight to_host(const gpu::FoundLightWords& words) {
    return {.position_m = glm::vec3(words.position_radius),
            .intensity = glm::vec3(words.intensity),
            .radius_m = words.position_radius.w,
            .spread_m = words.spread_m,
            .sightings = words.sightings,
            .clipped = words.clipped,
            .has_depth = words.has_depth != 0};
}

float total(const FoundLight& light) { return light.intensity.r + light.intensity.g + light.intensity.b; }

}  // namespace

LightEstimation::LightEstimation(vulkan::Device& device, const LightEstimationSettings& settings)
    : settings_(checked(settings)), runner_(device), tracks_(device) {
    graph::FrameGraph frame = runner_.begin();
    tracks_.reset(frame);
    runner_.submit(std::move(frame));
}

void LightEstimation::add(const RgbdFrame& frame, float radiance_scale) {
    graph::FrameGraph graph = runner_.begin();
    LightTrackIds tracks = tracks_.import(graph);
    FindLightsInputs inputs;
    inputs.depth_m = add_convert_depth(graph, frame.depth);
    inputs.depth_camera = make_camera(frame.depth.camera, frame.world_from_depth);
    inputs.color = add_convert_color(graph, frame.color);
    inputs.color_camera =
        make_camera(frame.color.camera, frame.world_from_depth * rigid_inverse(frame.color_from_depth));
    inputs.radiance_scale = radiance_scale;
    add_find_lights(graph, tracks, inputs, settings_.find);
    LightTracks::keep(graph, tracks);
    runner_.submit(std::move(graph));
}

std::vector<FoundLight> LightEstimation::found() {
    graph::FrameGraph frame = runner_.begin();
    const graph::Readback settled = frame.read_back(add_settle_lights(frame, tracks_.import(frame)));
    runner_.submit(std::move(frame));
    runner_.wait();
    std::vector<FoundLight> lights;
    for (const gpu::FoundLightWords& words : settled.as<gpu::FoundLightWords>())
        if (words.sightings >= std::max(settings_.min_sightings, 1u)) lights.push_back(to_host(words));
    std::stable_sort(lights.begin(), lights.end(),
                     [](const FoundLight& a, const FoundLight& b) { return total(a) > total(b); });
    return lights;
}

}  // namespace patina
