#include "reconstruction/lights/light_estimation.h"

#include <algorithm>

#include "engine/core/error.h"
#include "engine/core/shader_light.h"
#include "passes/input/convert_color.h"
#include "passes/input/convert_depth.h"
#include "reconstruction/frame_context.h"

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

FoundLight to_host(const gpu::FoundLight& found) {
    return {light_of(found.light),
            {.spread_m = found.spread_m,
             .sightings = found.sightings,
             .clipped = found.clipped,
             .has_depth = found.has_depth != 0}};
}

float total_intensity(const FoundLight& found) {
    const glm::vec3 intensity(found.light.intensity);
    return intensity.r + intensity.g + intensity.b;
}

}  // namespace

void sort_brightest_first(std::vector<FoundLight>& lights) {
    std::stable_sort(lights.begin(), lights.end(),
                     [](const FoundLight& a, const FoundLight& b) { return total_intensity(a) > total_intensity(b); });
}

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
    const FrameCameras cameras = make_frame_cameras(frame);
    inputs.depth_camera = cameras.depth.gpu;
    inputs.color = add_convert_color(graph, frame.color);
    inputs.color_camera = cameras.color.gpu;
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
    for (const gpu::FoundLight& found : settled.as<gpu::FoundLight>())
        if (found.sightings >= std::max(settings_.min_sightings, 1u)) lights.push_back(to_host(found));
    sort_brightest_first(lights);
    return lights;
}

}  // namespace patina
