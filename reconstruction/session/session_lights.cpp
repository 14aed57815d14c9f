#include "reconstruction/session/session_lights.h"

#include "cameras/open_sequence.h"
#include "engine/core/shader_light.h"
#include "reconstruction/api/access.h"
#include "reconstruction/session/choices.h"
#include "reconstruction/session/surroundings.h"
#include "scenes/files/scene_file.h"
#include "sensor/truth.h"

namespace patina {
namespace {

nlohmann::ordered_json to_json(glm::dvec3 v) { return {v.x, v.y, v.z}; }

/// What find_lights is asked for on behalf of a session.
LightsOptions search_of(const SessionOptions& options, glm::dvec3 world_offset_m, bool self) {
    const auto* named = std::get_if<LightsFromSequence>(&options.lighting);
    LightsOptions find;
    find.sequence = named && !self ? named->sequence : options.sequence;
    find.from = self ? LightsFrom::kMainSequence : LightsFrom::kLightingSequence;
    find.format = self ? options.format : "";
    find.frames = self ? options.frames : 0;
    if (!synthetic_scene(options)) find.main = named && !named->main.empty() ? named->main : options.sequence;
    find.main_format = options.format;
    find.main_frames = options.frames;
    find.hold_out = options.hold_out;
    find.track = options.poses == Poses::kTrack || options.poses == Poses::kPrior;
    find.seed = options.seed;
    find.fitting.white_albedo = options.white_albedo;
    find.reconstruction = Access::values(options.settings);
    if (options.seed) find.reconstruction.seed = *options.seed;
    find.world_offset_m = world_offset_m;
    find.callbacks = options.callbacks;
    return find;
}

/// A wrong path is an error at once, not the end of a search.
void check_named(vulkan::Device& device, const std::string& sequence) {
    if (!scenes::scene_name(sequence)) cameras::open_sequence(device, sequence);
}

/// Looks for lights; what goes wrong becomes a shortfall. Empty where nothing shines.
std::optional<Illumination> search(vulkan::Device& device, const LightsOptions& find, SessionLight& light) {
    try {
        Illumination found = find_lights(device, find);
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

Illumination illumination_of(const Lighting& lighting, glm::dvec3 world_offset_m) {
    Illumination given;
    given.given = true;
    given.found_by = lighting.found_by;
    given.world_offset_m = world_offset_m;
    for (Light light : lighting.lights) {
        light.position_m -= world_offset_m;
        given.lights.push_back({rounded_to_float(light)});
    }
    given.ambient = glm::dvec3(glm::vec3(lighting.ambient));  // as lamps are rounded
    return given;
}

Illumination illumination_from_file(const std::filesystem::path& file, glm::dvec3 world_offset_m) {
    return illumination_of(read_lighting(file), world_offset_m);
}

LightsSource lights_source(const SessionOptions& options) {
    const LightingChoice& choice = options.lighting;
    if (std::holds_alternative<LightsFromFile>(choice) || std::holds_alternative<Lighting>(choice))
        return LightsSource::kGiven;
    if (std::holds_alternative<NoLights>(choice)) return LightsSource::kNone;
    if (std::holds_alternative<LightsFromMain>(choice)) return LightsSource::kMainSequence;
    const bool there_is_one = std::holds_alternative<LightsFromSequence>(choice) ||
                              (!options.sequence.empty() && has_lighting_sequence(options.sequence));
    if (there_is_one) return LightsSource::kLightingSequence;
    return synthetic_scene(options) ? LightsSource::kNone : LightsSource::kSurroundings;
}

namespace {

SessionLight given_light(const SessionOptions& options, glm::dvec3 world_offset_m) {
    SessionLight light;
    if (const auto* file = std::get_if<LightsFromFile>(&options.lighting)) {
        light.illumination = illumination_from_file(file->file, world_offset_m);
        if (!shines(light.illumination))
            light.none_because = text("'", file->file.string(), "' holds no light, neither a lamp nor an ambient term");
    } else {
        light.illumination = illumination_of(std::get<Lighting>(options.lighting), world_offset_m);
        if (!shines(light.illumination)) light.none_because = "the lights that were given are none";
    }
    return light;
}

/// Of a lighting sequence that shows no lamp, but what else shines: windows, and shades of lamps that it does not look
/// into. From where nothing is seen, light begins as that of a recording without a lighting sequence. Empty where it
/// does not tell what is around.
std::optional<Illumination> light_without_lamps(vulkan::Device& device, const SessionOptions& options,
                                                glm::dvec3 world_offset_m) {
    if (synthetic_scene(options) || !tells_surroundings(device, search_of(options, world_offset_m, false)))
        return std::nullopt;
    Illumination light = light_of_surroundings(device, options, world_offset_m);
    if (!shines(light)) return std::nullopt;
    light.found_by = "lighting sequence";
    return light;
}

/// In the lighting sequence, then, where that tells nothing, in the main sequence; what goes wrong becomes a shortfall.
std::optional<Illumination> searched(vulkan::Device& device, const SessionOptions& options, glm::dvec3 world_offset_m,
                                     SessionLight& light) {
    const auto* named = std::get_if<LightsFromSequence>(&options.lighting);
    if (named) check_named(device, named->sequence);
    std::optional<Illumination> found = search(device, search_of(options, world_offset_m, false), light);
    if (found || options.sequence.empty()) return found;
    if (light.shortfalls.empty()) {
        found = light_without_lamps(device, options, world_offset_m);
        if (found) return found;
        light.shortfalls.push_back(
            text("no lamp was found in the lighting sequence", named ? text(" '", named->sequence, "'") : ""));
    }
    light.shortfalls.back() += text("; lights were looked for in what they light in '", options.sequence, "'");
    const size_t before = light.shortfalls.size();
    found = search(device, search_of(options, world_offset_m, true), light);
    if (!found && light.shortfalls.size() == before)
        light.shortfalls.push_back(text("neither lamps nor ambient light were found in '", options.sequence, "'"));
    return found;
}

/// In the main sequence alone.
std::optional<Illumination> searched_in_main(vulkan::Device& device, const SessionOptions& options,
                                             glm::dvec3 world_offset_m, SessionLight& light) {
    if (options.sequence.empty())
        throw Error("lights cannot be looked for in a source that is read once: give lights, or a lighting sequence");
    auto found = search(device, search_of(options, world_offset_m, true), light);
    if (!found && light.shortfalls.empty())
        light.shortfalls.push_back(text("neither lamps nor ambient light were found in '", options.sequence, "'"));
    return found;
}

}  // namespace

SessionLight light_of(vulkan::Device& device, const SessionOptions& options, glm::dvec3 world_offset_m) {
    const LightsSource source = lights_source(options);
    SessionLight light;
    if (source == LightsSource::kGiven) return given_light(options, world_offset_m);
    if (source == LightsSource::kNone) {
        light.none_because = std::holds_alternative<NoLights>(options.lighting)
                                 ? "no lights were asked for"
                                 : "no lights were given or found; " + give_lights(options);
        return light;
    }
    if (source == LightsSource::kSurroundings) {
        light.illumination = light_of_surroundings(device, options, world_offset_m);
        if (!shines(light.illumination)) light.none_because = "the recording is black; " + give_lights(options);
        return light;
    }
    auto found = source == LightsSource::kMainSequence ? searched_in_main(device, options, world_offset_m, light)
                                                       : searched(device, options, world_offset_m, light);
    if (!found) {
        light.none_because = "no light was found; " + give_lights(options);
        return light;
    }
    light.illumination = *std::move(found);
    return light;
}

nlohmann::ordered_json lights_json(const Illumination& illumination) {
    nlohmann::ordered_json json{{"found_by", illumination.found_by}};
    const bool found = illumination.found_by != "file";
    auto& list = json["lamps"] = nlohmann::ordered_json::array();
    for (const auto& [light, evidence] : illumination.lights) {
        nlohmann::ordered_json lamp{{"position_m", to_json(world_position_m(illumination, light))},
                                    {"intensity", to_json(light.intensity)}};
        if (is_sun(light)) lamp["sun"] = true;
        if (is_flat(light)) lamp["axis"] = to_json(light.axis);
        if (found) {
            lamp["radius_m"] = light.radius_m;
            lamp["spread_m"] = evidence.spread_m;
            lamp["sightings"] = evidence.sightings;
            lamp["clipped_sightings"] = evidence.clipped;
            lamp["triangulated"] = !evidence.has_depth;
            if (evidence.unseen) lamp["unseen"] = true;
            if (evidence.shown != glm::dvec3(0)) lamp["shown_intensity"] = to_json(evidence.shown);
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

void add_low_exposure(vulkan::Device& device, Pipeline& pipeline, const SessionOptions& options,
                      glm::dvec3 world_offset_m) {
    if (lights_source(options) != LightsSource::kLightingSequence) return;
    if (!pipeline.reflectance() || !pipeline.reflectance()->gathers()) return;
    const LightsOptions find = search_of(options, world_offset_m, false);
    if (find.main.empty() || scenes::scene_name(find.sequence)) return;  // a scene, or a camera
    try {
        for_each_low_exposure(device, find, [&](const RgbdFrame& frame, float scale) {
            pipeline.add_low_exposure(frame, scale, find.settings.find.threshold);
        });
        pipeline.end_low_exposure();
    } catch (const Interrupted&) {
        throw;
    } catch (const std::exception& error) {
        pipeline.end_low_exposure();
        report(options.callbacks, text("warning: what '", find.sequence, "' shows was left out: ", reason_of(error)));
    }
}

}  // namespace patina
