#include "reconstruction/session/find_lights.h"

#include <algorithm>
#include <memory>
#include <optional>

#include <fmt/format.h>

#include "cameras/open_sequence.h"
#include "engine/core/expect_path.h"
#include "engine/core/input_file.h"
#include "engine/core/printable.h"
#include "reconstruction/session/bright_surfaces.h"
#include "reconstruction/session/choices.h"
#include "reconstruction/session/localise.h"
#include "reconstruction/session/preflight.h"
#include "reconstruction/session/rgbd_frame.h"
#include "scenes/description/lighting_sequence.h"
#include "scenes/files/scene_file.h"
#include "scenes/render/synthetic_source.h"
#include "sensor/open.h"
#include "sensor/output/output_file.h"
#include "sensor/recentred_source.h"
#include "sensor/recording/exposure_check.h"
#include "sensor/truth.h"

namespace patina {
namespace {

namespace fs = std::filesystem;

// What a person is told while a lighting sequence is recorded is what is found in it.
static_assert(FindLightsSettings{}.threshold == sensor::kLampThreshold);

/// A sequence of low exposure, and the exposure of the one whose pixel values lights are told in.
struct LowExposure {
    std::unique_ptr<Source> source;
    std::optional<double> main_exposure;  ///< exposure_s * gain; empty: the lighting sequence's own
    FoundPoses poses;                     ///< by frame, where the source has none
};

double amount(const Exposure& exposure) { return exposure.exposure_s * exposure.gain; }

/// The exposure of the first frame that can be read.
double exposure_of(vulkan::Device& device, const fs::path& sequence) {
    const auto source = cameras::open_sequence(device, sequence);
    std::string reason = "it has no frames";
    while (const auto reading = source->next()) {
        if (const auto* frame = std::get_if<Frame>(&*reading)) return amount(frame->exposure);
        reason = std::get<Skipped>(*reading).reason;
    }
    throw Error("no frame of '", sequence.string(), "' could be used: ", reason);
}

/// The folder of the lighting sequence, and of the main sequence where that is known.
struct Folders {
    fs::path lighting;
    std::string main;
};

Folders folders_of(const LightsOptions& options) {
    const fs::path inside = sensor::lighting_of(options.sequence);
    if (!inside.empty()) return {inside, options.sequence};
    return {options.sequence, sensor::main_of(options.sequence).string()};
}

/// In the moved world, read ahead.
std::unique_ptr<Source> opened(vulkan::Device& device, const std::string& sequence, const std::string& format,
                               glm::dvec3 offset_m) {
    auto source = cameras::open_sequence_ahead(device, sequence, format);
    return std::make_unique<sensor::RecentredSource>(std::move(source), offset_m);
}

LowExposure open_recorded(vulkan::Device& device, const Folders& folders, glm::dvec3 offset_m) {
    LowExposure lighting;
    lighting.source = opened(device, folders.lighting.string(), "", offset_m);
    if (!folders.main.empty()) lighting.main_exposure = exposure_of(device, folders.main);
    return lighting;
}

LowExposure open_synthetic(const LightsOptions& options, const std::string& name, vulkan::Device& device) {
    const auto lighting = scenes::lighting_sequence(scenes::load_scene(name, {.seed = options.seed}));
    if (!lighting)
        throw Error("the scene '", name, "' has no lighting sequence: it needs a path and lamps with a radius");
    const scenes::SyntheticOptions recording{.frames = lighting->frames, .exposure = lighting->exposure};
    return {std::make_unique<scenes::SyntheticSource>(device, lighting->scene, recording), amount({}), {}};
}

/// Calls take(frame) for every frame of the source that can be read; it returns why it left the frame out, or nothing.
/// Throws Error where no frame could be used: `name` is the source's.
template <class Take>
void for_each_frame(const LightsOptions& options, Source& source, const std::string& name, const char* what,
                    Take&& take) {
    bool taken = false;
    std::string first_reason = "it has no frames";
    const SequenceInfo& info = source.info();
    const uint32_t frames = options.frames > 0 ? std::min(options.frames, *info.frames) : *info.frames;
    for (uint32_t done = 0; done < frames; ++done) {
        if (stop_requested(options.callbacks)) throw Interrupted("interrupted after ", done, " of ", frames, " frames");
        const auto reading = source.next();
        if (!reading) break;
        std::string reason;
        if (const auto* skipped = std::get_if<Skipped>(&*reading)) {
            reason = skipped->reason;
            report(options.callbacks, fmt::format("frame {} is skipped: {}", skipped->index, reason));
        } else {
            reason = take(std::get<Frame>(*reading));
        }
        taken = taken || reason.empty();
        if (done == 0) first_reason = std::move(reason);
        report(options.callbacks, {.task = what, .done = done + 1, .total = frames, .detail = what});
    }
    if (!taken) throw Error("no frame of '", name, "' could be used; the first was left out because: ", first_reason);
}

std::string without_pose(const Frame& frame) { return text("frame ", frame.index, " has no pose"); }

Illumination estimate(const LightsOptions& options, const LowExposure& lighting, const std::string& name,
                      vulkan::Device& device) {
    const SequenceInfo& info = lighting.source->info();
    LightEstimation estimation(device, options.settings);
    for_each_frame(options, *lighting.source, name, "lamps", [&](Frame frame) -> std::string {
        if (!lighting.poses.empty()) frame.world_from_camera = lighting.poses.at(frame.index);
        if (!frame.world_from_camera) return without_pose(frame);
        const double own = amount(frame.exposure);
        estimation.add(to_rgbd(info, frame), static_cast<float>(lighting.main_exposure.value_or(own) / own));
        return {};
    });
    Illumination found;
    found.found_by = "lighting sequence";
    found.lights = estimation.found();
    return found;
}

std::unique_ptr<Source> open_main(const LightsOptions& options, vulkan::Device& device, glm::dvec3 offset_m) {
    if (const auto scene = scenes::scene_name(options.sequence)) {
        return std::make_unique<scenes::SyntheticSource>(
            device, scenes::load_scene(*scene, {.seed = options.seed}),
            options.frames > 0 ? scenes::SyntheticOptions{.frames = options.frames} : scenes::SyntheticOptions{});
    }
    return opened(device, options.sequence, options.format, offset_m);
}

/// Lamps that the main sequence shows are clipped: where they are is known, how bright they are not.
LightEstimationSettings clipped_lamps(LightEstimationSettings settings) {
    settings.find.threshold = BrightSurfaces::kClipped;
    return settings;
}

/// Of the surface whose light is looked at; its own lights are not known yet, so that no highlight can be hidden.
ReconstructionSettings settings_of_fit(const LightsOptions& options, bool tracks) {
    ReconstructionSettings settings = options.reconstruction;
    if (!settings.reflectance) settings.reflectance.emplace();
    if (!tracks) {
        settings.tracking.reset();
        settings.keyframes.reset();
        return settings;
    }
    if (!settings.tracking) settings.tracking.emplace();
    if (!settings.keyframes) settings.keyframes.emplace();
    settings.tracking->hide_highlights = false;
    return settings;
}

Illumination fit(const LightsOptions& options, vulkan::Device& device, glm::dvec3 offset_m) {
    const std::unique_ptr<Source> source = open_main(options, device, offset_m);
    const SequenceInfo& info = source->info();
    const bool tracks = !info.has_poses || options.track;
    Pipeline pipeline(device, settings_of_fit(options, tracks));
    LightEstimation estimation(device, clipped_lamps(options.settings));
    BrightSurfaces bright;
    std::optional<RigidTransform> first_given;
    for_each_frame(options, *source, options.sequence, "lights", [&](const Frame& frame) -> std::string {
        if (!frame.world_from_camera && !tracks) return without_pose(frame);
        if (is_held_out(frame.index, options.hold_out)) return {};
        RgbdFrame rgbd = to_rgbd(info, frame);
        if (!first_given) first_given = rgbd.world_from_depth;
        if (tracks) rgbd.world_from_depth = *first_given;
        if (!pipeline.add(rgbd)) {
            const TrackingReport* report = pipeline.tracking_report();
            return text("frame ", frame.index, " was not fused", report ? ": " + report->reason : "");
        }
        if (tracks) rgbd.world_from_depth = pipeline.tracking_report()->world_from_depth;
        estimation.add(rgbd, 1);
        bright.add(frame.color);
        return {};
    });
    std::vector<glm::vec3> seen_m;
    for (const FoundLight& lamp : estimation.found()) seen_m.emplace_back(lamp.light.position_m);
    const FittedLights fitted = fit_lights(pipeline, seen_m, options.fitting);
    // Without a lamp all pixels tell the ambient light; the fit knows a part of the surface alone, if any.
    const glm::vec3 ambient = fitted.lamps.empty() ? bright.ambient(options.fitting.white_albedo) : fitted.ambient;
    return {"main sequence", fitted.lamps, offset_m, glm::dvec3(ambient), fitted.misfit, fitted.unexplained};
}

std::string main_of(const LightsOptions& options, const Folders& folders) {
    return options.main.empty() ? folders.main : options.main;
}

/// Whether poses of the lighting sequence, if it has some, are in the world of the reconstruction to come: that is the
/// main sequence's first camera where this has no poses.
bool in_main_world(vulkan::Device& device, const LightsOptions& options, const Folders& folders,
                   const Source& lighting) {
    if (!lighting.info().has_poses) return false;
    const std::string main = main_of(options, folders);
    return main.empty() || cameras::open_sequence(device, main, options.main_format)->info().has_poses;
}

/// Poses of the frames of a lighting sequence, found in the main sequence's world.
FoundPoses located(const LightsOptions& options, const Folders& folders, vulkan::Device& device, glm::dvec3 offset_m) {
    const std::string main = main_of(options, folders);
    if (main.empty()) {
        throw Error(
            "the lighting sequence '", folders.lighting.string(),
            "' has no poses, and no main sequence holds it in whose world they could be found: a trajectory.txt "
            "with poses is needed");
    }
    const std::unique_ptr<Source> room = opened(device, main, options.main_format, offset_m);
    const std::unique_ptr<Source> lighting = cameras::open_sequence(device, folders.lighting);
    LocaliseOptions find{options.reconstruction, options.main_frames, options.track, {}};
    find.on_frame = [&](const char* what, uint32_t done, uint32_t total) {
        if (stop_requested(options.callbacks))
            throw Interrupted("interrupted after ", done, " of ", total, " frames of the ", what);
    };
    FoundPoses poses = localise(device, *room, *lighting, find);
    const auto count = std::count_if(poses.begin(), poses.end(), [](const auto& pose) { return pose.has_value(); });
    report(options.callbacks, fmt::format("{} of {} frames of '{}' were found in the room of '{}'", count, poses.size(),
                                          folders.lighting.string(), main));
    return poses;
}

/// Of the main sequence where it is known, else of the sequence that is looked at.
glm::dvec3 offset_of(vulkan::Device& device, const LightsOptions& options, const Folders& folders, bool low_exposure) {
    if (options.world_offset_m) return *options.world_offset_m;
    if (scenes::scene_name(options.sequence)) return glm::dvec3(0);
    if (!low_exposure) return world_offset_of(options.sequence, options.format, cameras::payload_decoders(device));
    const std::string main = main_of(options, folders);
    return main.empty() ? world_offset_of(folders.lighting.string(), "", cameras::payload_decoders(device))
                        : world_offset_of(main, options.main_format, cameras::payload_decoders(device));
}

Illumination find_at_low_exposure(const LightsOptions& options, const Folders& folders, vulkan::Device& device,
                                  glm::dvec3 offset_m) {
    const auto scene = scenes::scene_name(options.sequence);
    LowExposure lighting = scene ? open_synthetic(options, *scene, device) : open_recorded(device, folders, offset_m);
    if (!scene && !in_main_world(device, options, folders, *lighting.source))
        lighting.poses = located(options, folders, device, offset_m);
    const std::string name = scene ? options.sequence : folders.lighting.string();
    Illumination found = estimate(options, lighting, name, device);
    found.world_offset_m = offset_m;
    return found;
}

/// Whether a reconstruction with these settings gathers light, where the recording's surfaces light each other.
bool gathers(const ReconstructionSettings& settings) {
    return settings.fusion.color && (!settings.reflectance || settings.reflectance->refine.gathered_rays > 0);
}

}  // namespace

bool may_lack_lamps(const Illumination& illumination) {
    if (illumination.given) return false;
    return illumination.found_by == "lighting sequence" || illumination.found_by == "surroundings";
}

bool shines(const Illumination& illumination) {
    return !illumination.lights.empty() || illumination.ambient != glm::dvec3(0);
}

glm::dvec3 world_position_m(const Illumination& illumination, const Light& light) {
    return illumination.world_offset_m + light.position_m;
}

Lighting lighting_of(const Illumination& illumination) {
    Lighting lighting;
    lighting.found_by = illumination.found_by;
    lighting.ambient = illumination.ambient;
    lighting.lights = lights_of(illumination);
    for (Light& light : lighting.lights) light.position_m = world_position_m(illumination, light);
    return lighting;
}

std::vector<Light> lights_of(const Illumination& illumination) {
    std::vector<Light> lights;
    for (const FoundLight& found : illumination.lights) lights.push_back(found.light);
    return lights;
}

bool has_lighting_sequence(const std::string& sequence) {
    if (const auto scene = scenes::scene_name(sequence))
        return scenes::lighting_sequence(scenes::load_scene(*scene)).has_value();
    return !sensor::lighting_of(sequence).empty();
}

Illumination find_lights(vulkan::Device& device, const LightsOptions& options) {
    const bool is_one = fs::absolute(options.sequence).lexically_normal().filename() == "lighting";
    const bool low_exposure = options.from == LightsFrom::kLightingSequence ||
                              (options.from == LightsFrom::kAny && (is_one || has_lighting_sequence(options.sequence)));
    const Folders folders = scenes::scene_name(options.sequence) ? Folders{} : folders_of(options);
    const glm::dvec3 offset_m = offset_of(device, options, folders, low_exposure);
    return low_exposure ? find_at_low_exposure(options, folders, device, offset_m) : fit(options, device, offset_m);
}

bool tells_surroundings(vulkan::Device& device, const LightsOptions& options) {
    if (options.track || !gathers(options.reconstruction) || scenes::scene_name(options.sequence)) return false;
    const Folders folders = folders_of(options);
    const std::string main = main_of(options, folders);
    if (main.empty()) return false;
    const auto room = cameras::open_sequence(device, main, options.main_format);
    const auto lighting = cameras::open_sequence(device, folders.lighting);
    return room->info().indirect_light && room->info().has_poses && lighting->info().has_poses;
}

void for_each_low_exposure(vulkan::Device& device, const LightsOptions& options, const TakeLowExposure& take) {
    const Folders folders = folders_of(options);
    const std::string main = main_of(options, folders);
    if (main.empty()) return;
    const LowExposure lighting = open_recorded(device, folders, offset_of(device, options, folders, true));
    if (!in_main_world(device, options, folders, *lighting.source) || options.track) return;
    const SequenceInfo& info = lighting.source->info();
    const double main_exposure = lighting.main_exposure ? *lighting.main_exposure : exposure_of(device, main);
    for_each_frame(options, *lighting.source, folders.lighting.string(), "surroundings", [&](const Frame& frame) {
        if (!frame.world_from_camera) return without_pose(frame);
        take(to_rgbd(info, frame), static_cast<float>(main_exposure / amount(frame.exposure)));
        return std::string();
    });
}

}  // namespace patina
