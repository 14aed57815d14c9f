#include "tools/lights.h"

#include <algorithm>
#include <memory>
#include <optional>

#include <fmt/format.h>

#include "engine/core/expect_path.h"
#include "engine/core/input_file.h"
#include "engine/core/printable.h"
#include "sensor/open.h"
#include "sensor/output/output_file.h"
#include "sensor/prefetch.h"
#include "sensor/recentred_source.h"
#include "sensor/synthetic/lighting_sequence.h"
#include "sensor/synthetic/scene_file.h"
#include "sensor/synthetic/synthetic_source.h"
#include "sensor/truth.h"
#include "tools/bright_surfaces.h"
#include "tools/inputs.h"
#include "tools/interrupt.h"
#include "tools/localise.h"
#include "tools/preflight.h"
#include "tools/progress.h"
#include "tools/rgbd_frame.h"
#include "tools/standard_streams.h"

namespace patina::tools {
namespace {

namespace fs = std::filesystem;

constexpr float kClippedLuminance = 0.98f;

/// A sequence of low exposure, and the exposure of the one whose pixel values lights are told in.
struct Lighting {
    std::unique_ptr<sensor::Source> source;
    std::optional<double> main_exposure;  ///< exposure_s * gain; empty: the lighting sequence's own
    FoundPoses poses;                     ///< by frame, where the source has none
};

double amount(const sensor::Exposure& exposure) { return exposure.exposure_s * exposure.gain; }

/// The exposure of the first frame that can be read.
double exposure_of(const fs::path& sequence) {
    const auto source = sensor::open_sequence(sequence);
    std::string reason = "it has no frames";
    while (const auto reading = source->next()) {
        if (const auto* frame = std::get_if<sensor::Frame>(&*reading)) return amount(frame->exposure);
        reason = std::get<sensor::Skipped>(*reading).reason;
    }
    throw Error("no frame of '", sequence.string(), "' could be used: ", reason);
}

/// The folder of the lighting sequence, and of the main sequence where that is known.
struct Folders {
    fs::path lighting;
    std::string main;
};

/// Of a sequence that is named by its folder or by its sequence.json.
fs::path folder_of(const fs::path& sequence) {
    return sequence.filename() == "sequence.json" ? fs::absolute(sequence).parent_path() : sequence;
}

Folders folders_of(const LightsOptions& options) {
    const fs::path folder = folder_of(options.sequence), inside = folder / "lighting";
    const fs::path beside = fs::absolute(folder).lexically_normal().parent_path();
    if (is_folder(inside)) return {inside, folder.string()};
    if (folder.filename() == "lighting" && path_exists(beside / "sequence.json")) return {folder, beside.string()};
    return {folder, ""};
}

/// In the moved world, read ahead.
std::unique_ptr<sensor::Source> opened(const std::string& sequence, const std::string& format, glm::dvec3 offset_m) {
    auto source = std::make_unique<sensor::PrefetchSource>(sensor::open_sequence(sequence, format));
    return std::make_unique<sensor::RecentredSource>(std::move(source), offset_m);
}

Lighting open_recorded(const Folders& folders, glm::dvec3 offset_m) {
    Lighting lighting;
    lighting.source = opened(folders.lighting.string(), "", offset_m);
    if (!folders.main.empty()) lighting.main_exposure = exposure_of(folders.main);
    return lighting;
}

Lighting open_synthetic(const LightsOptions& options, const std::string& name, vulkan::Device& device) {
    const auto lighting = sensor::lighting_sequence(sensor::load_scene(name, {.seed = options.seed}));
    if (!lighting)
        throw Error("the scene '", name, "' has no lighting sequence: it needs a path and lamps with a radius");
    const sensor::SyntheticOptions recording{.frames = lighting->frames, .exposure = lighting->exposure};
    return {std::make_unique<sensor::SyntheticSource>(device, lighting->scene, recording), amount({}), {}};
}

/// Calls take(frame) for every frame of the source that can be read; it returns why it left the frame out, or nothing.
/// Throws Error where no frame could be used: `name` is the source's.
template <class Take>
void for_each_frame(const LightsOptions& options, sensor::Source& source, const std::string& name, const char* what,
                    Take&& take) {
    const InterruptGuard interrupt;
    bool taken = false;
    std::string first_reason = "it has no frames";
    const sensor::SequenceInfo& info = source.info();
    const uint32_t frames = options.frames > 0 ? std::min(options.frames, info.frames) : info.frames;
    Progress progress(frames, options.quiet);
    for (uint32_t done = 0; done < frames; ++done) {
        if (interrupt.requested()) throw Interrupted("interrupted after ", done, " of ", frames, " frames");
        const auto reading = source.next();
        if (!reading) break;
        std::string reason;
        if (const auto* skipped = std::get_if<sensor::Skipped>(&*reading)) {
            reason = skipped->reason;
            progress.say(fmt::format("frame {} is skipped: {}", skipped->index, reason));
        } else {
            reason = take(std::get<sensor::Frame>(*reading));
        }
        taken = taken || reason.empty();
        if (done == 0) first_reason = std::move(reason);
        progress.update(done + 1, what);
    }
    if (!taken) throw Error("no frame of '", name, "' could be used; the first was left out because: ", first_reason);
}

std::string without_pose(const sensor::Frame& frame) { return text("frame ", frame.index, " has no pose"); }

Illumination estimate(const LightsOptions& options, const Lighting& lighting, const std::string& name,
                      vulkan::Device& device) {
    const sensor::SequenceInfo& info = lighting.source->info();
    LightEstimation estimation(device, options.settings);
    for_each_frame(options, *lighting.source, name, "lamps", [&](sensor::Frame frame) -> std::string {
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

std::unique_ptr<sensor::Source> open_main(const LightsOptions& options, vulkan::Device& device, glm::dvec3 offset_m) {
    if (const auto scene = sensor::scene_name(options.sequence)) {
        return std::make_unique<sensor::SyntheticSource>(
            device, sensor::load_scene(*scene, {.seed = options.seed}),
            options.frames > 0 ? sensor::SyntheticOptions{.frames = options.frames} : sensor::SyntheticOptions{});
    }
    return opened(options.sequence, options.format, offset_m);
}

/// Lamps that the main sequence shows are clipped: where they are is known, how bright they are not.
LightEstimationSettings clipped_lamps(LightEstimationSettings settings) {
    settings.find.threshold = kClippedLuminance;
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

Illumination fit(const LightsOptions& options, glm::dvec3 offset_m) {
    vulkan::Device device(options.device);
    const std::unique_ptr<sensor::Source> source = open_main(options, device, offset_m);
    const sensor::SequenceInfo& info = source->info();
    const bool tracks = !info.has_poses || options.track;
    Reconstruction reconstruction(device, settings_of_fit(options, tracks));
    LightEstimation estimation(device, clipped_lamps(options.settings));
    BrightSurfaces bright;
    std::optional<RigidTransform> first_given;
    for_each_frame(options, *source, options.sequence, "lights", [&](const sensor::Frame& frame) -> std::string {
        if (!frame.world_from_camera && !tracks) return without_pose(frame);
        RgbdFrame rgbd = to_rgbd(info, frame);
        if (!first_given) first_given = rgbd.world_from_depth;
        if (tracks) rgbd.world_from_depth = *first_given;
        if (!reconstruction.add(rgbd)) {
            const TrackingReport* report = reconstruction.tracking_report();
            return text("frame ", frame.index, " was not fused", report ? ": " + report->reason : "");
        }
        if (tracks) rgbd.world_from_depth = reconstruction.tracking_report()->world_from_depth;
        estimation.add(rgbd, 1);
        bright.add(frame.color);
        return {};
    });
    std::vector<glm::vec3> seen_m;
    for (const FoundLight& lamp : estimation.found()) seen_m.push_back(lamp.position_m);
    const FittedLights fitted = fit_lights(reconstruction, seen_m, options.fitting);
    // Without a lamp all pixels tell the ambient light; the fit knows a part of the surface alone, if any.
    const glm::vec3 ambient = fitted.lamps.empty() ? bright.ambient() : fitted.ambient;
    return {"main sequence", fitted.lamps, offset_m, ambient, fitted.misfit, fitted.unexplained};
}

std::string main_of(const LightsOptions& options, const Folders& folders) {
    return options.main.empty() ? folders.main : options.main;
}

/// Whether poses of the lighting sequence, if it has some, are in the world of the reconstruction to come: that is the
/// main sequence's first camera where this has no poses.
bool in_main_world(const LightsOptions& options, const Folders& folders, const sensor::Source& lighting) {
    if (!lighting.info().has_poses) return false;
    const std::string main = main_of(options, folders);
    return main.empty() || sensor::open_sequence(main, options.main_format)->info().has_poses;
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
    const InterruptGuard interrupt;
    const std::unique_ptr<sensor::Source> room = opened(main, options.main_format, offset_m);
    const std::unique_ptr<sensor::Source> lighting = sensor::open_sequence(folders.lighting);
    LocaliseOptions find{options.reconstruction, options.main_frames, options.track, {}};
    find.on_frame = [&](const char* what, uint32_t done, uint32_t total) {
        if (interrupt.requested())
            throw Interrupted("interrupted after ", done, " of ", total, " frames of the ", what);
    };
    FoundPoses poses = localise(device, *room, *lighting, find);
    if (!options.quiet) {
        const auto count = std::count_if(poses.begin(), poses.end(), [](const auto& pose) { return pose.has_value(); });
        print_error("{} of {} frames of '{}' were found in the room of '{}'\n", count, poses.size(),
                    printable(folders.lighting.string()), printable(main));
    }
    return poses;
}

void print(const Illumination& found, const FoundLight& light) {
    const glm::dvec3 at_m = world_position_m(found, light);
    print_out(
        "{:8.3f} {:8.3f} {:8.3f} m  {:8.3f} {:8.3f} {:8.3f}  radius {:.3f} m  spread {:.1f} mm  {} sightings{}{}\n",
        at_m.x, at_m.y, at_m.z, light.intensity.r, light.intensity.g, light.intensity.b, light.radius_m,
        1000 * light.spread_m, light.sightings, light.has_depth ? "" : ", triangulated",
        light.clipped > 0 ? ", clipped: the true intensity is higher" : "");
}

/// Of the main sequence where it is known, else of the sequence that is looked at.
glm::dvec3 offset_of(const LightsOptions& options, const Folders& folders, bool low_exposure) {
    if (options.world_offset_m) return *options.world_offset_m;
    if (sensor::scene_name(options.sequence)) return glm::dvec3(0);
    if (!low_exposure) return world_offset_of(options.sequence, options.format);
    const std::string main = main_of(options, folders);
    return main.empty() ? world_offset_of(folders.lighting.string(), "") : world_offset_of(main, options.main_format);
}

Illumination find_at_low_exposure(const LightsOptions& options, const Folders& folders, glm::dvec3 offset_m) {
    const auto scene = sensor::scene_name(options.sequence);
    std::optional<vulkan::Device> device;  // outlives the source, which may compute on it
    Lighting lighting;
    if (!scene) lighting = open_recorded(folders, offset_m);
    device.emplace(options.device);
    if (scene) {
        lighting = open_synthetic(options, *scene, *device);
    } else if (!in_main_world(options, folders, *lighting.source)) {
        lighting.poses = located(options, folders, *device, offset_m);
    }
    const std::string name = scene ? options.sequence : folders.lighting.string();
    Illumination found = estimate(options, lighting, name, *device);
    found.world_offset_m = offset_m;
    return found;
}

}  // namespace

bool shines(const Illumination& illumination) {
    return !illumination.lights.empty() || illumination.ambient != glm::vec3(0);
}

void print_lights(const Illumination& illumination) {
    for (const FoundLight& light : illumination.lights) print(illumination, light);
    const glm::vec3 ambient = illumination.ambient;
    if (ambient != glm::vec3(0)) print_out("ambient {:.4f} {:.4f} {:.4f}\n", ambient.r, ambient.g, ambient.b);
    if (illumination.lights.empty()) print_out("no lamps found\n");
}

glm::dvec3 world_position_m(const Illumination& illumination, const FoundLight& light) {
    return illumination.world_offset_m + glm::dvec3(light.position_m);
}

void write_lights_json(const fs::path& file, const Illumination& illumination) {
    std::vector<sensor::PointLight> lights;
    for (const FoundLight& light : illumination.lights)
        lights.push_back({world_position_m(illumination, light), glm::dvec3(light.intensity), light.radius_m});
    sensor::write_lights(file, lights, glm::dvec3(illumination.ambient));
}

bool has_lighting_sequence(const std::string& sequence) {
    if (const auto scene = sensor::scene_name(sequence))
        return sensor::lighting_sequence(sensor::load_scene(*scene)).has_value();
    return is_folder(folder_of(sequence) / "lighting");
}

Illumination find_lights(const LightsOptions& options) {
    std::optional<sensor::OutputFile> out;
    if (!options.out.empty()) out.emplace(options.out, sequence_inputs(options.sequence));
    const bool is_one = fs::absolute(options.sequence).lexically_normal().filename() == "lighting";
    const bool low_exposure = options.from == LightsFrom::kLightingSequence ||
                              (options.from == LightsFrom::kAny && (is_one || has_lighting_sequence(options.sequence)));
    const Folders folders = sensor::scene_name(options.sequence) ? Folders{} : folders_of(options);
    const glm::dvec3 offset_m = offset_of(options, folders, low_exposure);
    const Illumination found = low_exposure ? find_at_low_exposure(options, folders, offset_m) : fit(options, offset_m);
    if (out) {
        write_lights_json(out->partial_path(), found);
        out->finish();
    }
    return found;
}

}  // namespace patina::tools
