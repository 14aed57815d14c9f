#include "tools/render/other_light.h"

#include <algorithm>
#include <utility>

#include <glm/gtc/quaternion.hpp>

#include "export/surface_survey.h"
#include "export/upright.h"
#include "reconstruction/lights/split_environment.h"
#include "reconstruction/session/session_lights.h"
#include "scenes/render/environment.h"
#include "shared/lighting/lights.h"

namespace patina::tools {

namespace {

bool is_environment(const std::filesystem::path& file) {
    return file.extension() == ".hdr" || file.extension() == ".exr";
}

void add_lamps(Lighting& lighting, const std::filesystem::path& file) {
    const Lighting read = read_lighting(file);
    lighting.lights.insert(lighting.lights.end(), read.lights.begin(), read.lights.end());
    lighting.ambient += read.ambient;
}

glm::dquat y_up_from_world(SessionCore& session) {
    UpHints hints;
    if (!session.settings().tracking) hints.gravity = session.info().gravity;
    for (const TimedPose& pose : session.poses()) hints.cameras.push_back(pose.world_from_camera);
    SurfaceSurvey survey;
    survey.add(session.pipeline().extract_surface(), {});
    return find_upright(hints, survey.patches()).y_up_from_world;
}

}  // namespace

OtherLight read_other_light(std::span<const std::filesystem::path> files, double turn_deg) {
    OtherLight light;
    light.turn_deg = turn_deg;
    for (const std::filesystem::path& file : files) {
        if (!is_environment(file)) {
            add_lamps(light.lighting, file);
        } else if (light.environment) {
            throw Error("'", file.string(), "' is a second environment, but views have one");
        } else {
            light.environment = scenes::read_environment(file);
        }
    }
    if (light.lighting.lights.size() > gpu::kMaxPointLights)
        throw Error("--relight gives ", light.lighting.lights.size(), " lamps, views have at most ",
                    gpu::kMaxPointLights);
    if (turn_deg != 0 && !light.environment)
        throw Error("--relight-turn turns an environment, but --relight names none: give a .hdr or .exr file");
    return light;
}

Relighting relighting_of(const OtherLight& light, SessionCore& session) {
    const Illumination lamps = illumination_of(light.lighting, session.world_offset_m());
    Relighting relighting{.lights = lights_of(lamps), .ambient = lamps.ambient, .far_field = {}};
    if (!light.environment) return relighting;
    const glm::dquat turn = glm::angleAxis(glm::radians(-light.turn_deg), glm::dvec3(0, 1, 0));
    SplitEnvironment split =
        split_environment(*light.environment, glm::mat3_cast(turn * y_up_from_world(session)),
                          std::min(kMostEnvironmentLamps, gpu::kMaxPointLights - relighting.lights.size()));
    relighting.lights.insert(relighting.lights.end(), split.lamps.begin(), split.lamps.end());
    relighting.far_field = std::move(split.far_field);
    return relighting;
}

}  // namespace patina::tools
