#include "tools/run_lights.h"

#include "sensor/truth.h"

namespace patina::tools {
namespace {

nlohmann::ordered_json to_json(glm::vec3 v) { return {v.x, v.y, v.z}; }

}  // namespace

Illumination illumination_from_file(const std::filesystem::path& file) {
    Illumination given;
    given.found_by = "file";
    for (const sensor::PointLight& light : sensor::read_lights(file)) {
        FoundLight known;
        known.position_m = glm::vec3(light.position_m);
        known.intensity = glm::vec3(light.intensity);
        known.radius_m = static_cast<float>(light.radius_m);
        given.lights.push_back(known);
    }
    given.ambient = glm::vec3(sensor::read_ambient(file));
    return given;
}

Illumination lights_of(const SequenceOptions& options) {
    if (!options.lights.empty()) return illumination_from_file(options.lights);
    const bool by_default = options.lighting.empty();
    if (options.lighting == "none" || (by_default && !has_lighting_sequence(options.sequence))) return {};
    const bool self = options.lighting == "self";
    LightsOptions find;
    find.sequence = self || by_default ? options.sequence : options.lighting;
    find.from = self ? LightsFrom::kMainSequence : LightsFrom::kLightingSequence;
    find.format = self ? options.format : "";
    find.frames = self ? options.frames : 0;
    if (!options.sequence.starts_with("synthetic:")) find.main = options.sequence;
    find.main_format = options.format;
    find.main_frames = options.frames;
    find.track = options.poses == PoseMode::kTrack || options.poses == PoseMode::kPrior;
    find.reconstruction = options.settings;
    find.quiet = options.quiet;
    find.device = options.device;
    Illumination found = find_lights(find);
    if (found.lights.empty() && !by_default) throw Error("no lamp was found in the sequence '", find.sequence, "'");
    return found;
}

std::vector<PointLight> point_lights(const Illumination& illumination) {
    std::vector<PointLight> lights;
    for (const FoundLight& light : illumination.lights)
        lights.push_back({light.position_m, light.intensity, light.radius_m});
    return lights;
}

nlohmann::ordered_json lights_json(const Illumination& illumination) {
    nlohmann::ordered_json json{{"found_by", illumination.found_by}};
    const bool found = illumination.found_by != "file";
    auto& list = json["lamps"] = nlohmann::ordered_json::array();
    for (const FoundLight& light : illumination.lights) {
        nlohmann::ordered_json lamp{{"position_m", to_json(light.position_m)}, {"intensity", to_json(light.intensity)}};
        if (found) {
            lamp["radius_m"] = light.radius_m;
            lamp["spread_m"] = light.spread_m;
            lamp["sightings"] = light.sightings;
            lamp["clipped_sightings"] = light.clipped;
            lamp["triangulated"] = !light.has_depth;
        }
        list.push_back(std::move(lamp));
    }
    json["ambient"] = to_json(illumination.ambient);
    if (illumination.found_by == "main sequence") {
        json["misfit"] = illumination.misfit;
        json["unexplained_highlights"] = illumination.unexplained;
    }
    return json;
}

}  // namespace patina::tools
