#include "tools/run_lights.h"

#include "sensor/open.h"
#include "sensor/synthetic/scene_file.h"
#include "sensor/truth.h"
#include "tools/interrupt.h"

namespace patina::tools {
namespace {

constexpr const char* kWhatToGive =
    "give --lights FILE, --lighting SEQUENCE (recorded at low exposure) or --lighting self";

nlohmann::ordered_json to_json(glm::dvec3 v) { return {v.x, v.y, v.z}; }

/// What find_lights is asked for on behalf of a run.
LightsOptions search_of(const SequenceOptions& options, glm::dvec3 world_offset_m, bool self) {
    const bool named = !options.lighting.empty() && !self;
    LightsOptions find;
    find.sequence = named ? options.lighting : options.sequence;
    find.from = self ? LightsFrom::kMainSequence : LightsFrom::kLightingSequence;
    find.format = self ? options.format : "";
    find.frames = self ? options.frames : 0;
    if (!sensor::scene_name(options.sequence)) find.main = options.sequence;
    find.main_format = options.format;
    find.main_frames = options.frames;
    find.track = options.poses == PoseMode::kTrack || options.poses == PoseMode::kPrior;
    find.seed = options.seed;
    find.reconstruction = options.settings;
    find.world_offset_m = world_offset_m;
    find.quiet = options.quiet;
    find.device = options.device;
    return find;
}

/// A wrong path is an error at once, not the end of a search.
void check_named(const std::string& sequence) {
    if (!sensor::scene_name(sequence)) sensor::open_sequence(sequence);
}

/// Looks for lights; what goes wrong becomes a shortfall. Empty where nothing shines.
std::optional<Illumination> search(const LightsOptions& find, LightOfRun& light) {
    try {
        Illumination found = find_lights(find);
        if (shines(found)) return found;
    } catch (const Interrupted&) {
        throw;
    } catch (const std::exception& error) {
        light.shortfalls.push_back(
            text("the lights could not be looked for in '", find.sequence, "': ", reason_of(error)));
    }
    return std::nullopt;
}

}  // namespace

Illumination illumination_from_file(const std::filesystem::path& file, glm::dvec3 world_offset_m) {
    Illumination given;
    given.found_by = "file";
    given.world_offset_m = world_offset_m;
    for (const sensor::PointLight& light : sensor::read_lights(file)) {
        FoundLight known;
        known.position_m = glm::vec3(light.position_m - world_offset_m);
        known.intensity = glm::vec3(light.intensity);
        known.radius_m = static_cast<float>(light.radius_m);
        given.lights.push_back(known);
    }
    given.ambient = glm::vec3(sensor::read_ambient(file));
    return given;
}

LightsSource lights_source(const SequenceOptions& options) {
    if (!options.lights.empty()) return LightsSource::kFile;
    if (options.lighting == "none") return LightsSource::kNone;
    if (options.lighting == "self") return LightsSource::kMainSequence;
    const bool there_is_one = !options.lighting.empty() || has_lighting_sequence(options.sequence);
    return there_is_one ? LightsSource::kLightingSequence : LightsSource::kNone;
}

LightOfRun light_of(const SequenceOptions& options, glm::dvec3 world_offset_m) {
    LightOfRun light;
    const LightsSource source = lights_source(options);
    if (source == LightsSource::kFile) {
        light.illumination = illumination_from_file(options.lights, world_offset_m);
        if (!shines(light.illumination))
            light.none_because =
                text("'", options.lights.string(), "' holds no light, neither a lamp nor an ambient term");
        return light;
    }
    if (source == LightsSource::kNone) {
        light.none_because = options.lighting == "none" ? "--lighting none asks for none"
                                                        : text("no lights were given or found; ", kWhatToGive);
        return light;
    }
    const bool self = source == LightsSource::kMainSequence;
    if (!options.lighting.empty() && !self) check_named(options.lighting);
    std::optional<Illumination> found = search(search_of(options, world_offset_m, self), light);
    bool failed = !light.shortfalls.empty();
    if (!found && !self) {
        if (!failed)
            light.shortfalls.push_back(text("no lamp was found in the lighting sequence",
                                            options.lighting.empty() ? "" : text(" '", options.lighting, "'")));
        light.shortfalls.back() += text("; lights were looked for in what they light in '", options.sequence, "'");
        const size_t before = light.shortfalls.size();
        found = search(search_of(options, world_offset_m, true), light);
        failed = light.shortfalls.size() > before;
    }
    if (!found) {
        if (!failed)
            light.shortfalls.push_back(text("neither lamps nor ambient light were found in '", options.sequence, "'"));
        light.none_because = text("no light was found; ", kWhatToGive);
        return light;
    }
    light.illumination = *std::move(found);
    return light;
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
        nlohmann::ordered_json lamp{{"position_m", to_json(world_position_m(illumination, light))},
                                    {"intensity", to_json(glm::dvec3(light.intensity))}};
        if (found) {
            lamp["radius_m"] = light.radius_m;
            lamp["spread_m"] = light.spread_m;
            lamp["sightings"] = light.sightings;
            lamp["clipped_sightings"] = light.clipped;
            lamp["triangulated"] = !light.has_depth;
        }
        list.push_back(std::move(lamp));
    }
    json["ambient"] = to_json(glm::dvec3(illumination.ambient));
    if (illumination.found_by == "main sequence") {
        json["misfit"] = illumination.misfit;
        json["unexplained_highlights"] = illumination.unexplained;
    }
    return json;
}

}  // namespace patina::tools
