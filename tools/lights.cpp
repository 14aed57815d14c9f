#include "tools/lights.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

#include "sensor/open.h"
#include "sensor/prefetch.h"
#include "sensor/synthetic/lighting_sequence.h"
#include "sensor/synthetic/scene_file.h"
#include "sensor/synthetic/synthetic_source.h"
#include "sensor/truth.h"
#include "tools/interrupt.h"
#include "tools/localise.h"
#include "tools/progress.h"
#include "tools/rgbd_frame.h"

namespace patina::tools {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kSynthetic = "synthetic:";

/// The scene's name; empty for a folder.
std::optional<std::string> scene_name(const std::string& sequence) {
    if (!sequence.starts_with(kSynthetic)) return std::nullopt;
    return sequence.substr(kSynthetic.size());
}

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

Folders folders_of(const LightsOptions& options) {
    const fs::path folder = options.sequence, inside = folder / "lighting";
    const fs::path beside = fs::absolute(folder).lexically_normal().parent_path();
    if (fs::is_directory(inside)) return {inside, folder.string()};
    if (folder.filename() == "lighting" && fs::exists(beside / "sequence.json")) return {folder, beside.string()};
    return {folder, ""};
}

Lighting open_recorded(const Folders& folders) {
    Lighting lighting;
    lighting.source = sensor::open_sequence(folders.lighting);
    if (!folders.main.empty()) lighting.main_exposure = exposure_of(folders.main);
    lighting.source = std::make_unique<sensor::PrefetchSource>(std::move(lighting.source));
    return lighting;
}

Lighting open_synthetic(const std::string& name, vulkan::Device& device) {
    const auto lighting = sensor::lighting_sequence(sensor::load_scene(name));
    if (!lighting)
        throw Error("the scene '", name, "' has no lighting sequence: it needs a path and lamps with a radius");
    const sensor::SyntheticOptions recording{.frames = lighting->frames, .exposure = lighting->exposure};
    return {std::make_unique<sensor::SyntheticSource>(device, lighting->scene, recording), amount({}), {}};
}

/// Calls take(frame) for every frame of the source that can be used.
template <class Take>
void for_each_frame(const LightsOptions& options, sensor::Source& source, const char* what, Take&& take) {
    const InterruptGuard interrupt;
    const sensor::SequenceInfo& info = source.info();
    const uint32_t frames = options.frames > 0 ? std::min(options.frames, info.frames) : info.frames;
    Progress progress(frames, options.quiet);
    for (uint32_t done = 0; done < frames; ++done) {
        if (interrupt.requested()) throw Interrupted("interrupted after ", done, " of ", frames, " frames");
        const auto reading = source.next();
        if (!reading) break;
        if (const auto* skipped = std::get_if<sensor::Skipped>(&*reading)) {
            progress.say(fmt::format("frame {} is skipped: {}", skipped->index, skipped->reason));
        } else {
            take(std::get<sensor::Frame>(*reading));
        }
        progress.update(done + 1, what);
    }
}

Illumination estimate(const LightsOptions& options, const Lighting& lighting, vulkan::Device& device) {
    const sensor::SequenceInfo& info = lighting.source->info();
    LightEstimation estimation(device, options.settings);
    for_each_frame(options, *lighting.source, "lamps", [&](sensor::Frame frame) {
        if (!lighting.poses.empty()) frame.world_from_camera = lighting.poses.at(frame.index);
        if (!frame.world_from_camera) return;
        const double own = amount(frame.exposure);
        estimation.add(to_rgbd(info, frame), static_cast<float>(lighting.main_exposure.value_or(own) / own));
    });
    Illumination found;
    found.found_by = "lighting sequence";
    found.lights = estimation.found();
    return found;
}

std::unique_ptr<sensor::Source> open_main(const LightsOptions& options, vulkan::Device& device) {
    if (const auto scene = scene_name(options.sequence)) {
        return std::make_unique<sensor::SyntheticSource>(
            device, sensor::load_scene(*scene),
            options.frames > 0 ? sensor::SyntheticOptions{.frames = options.frames} : sensor::SyntheticOptions{});
    }
    auto source = sensor::open_sequence(options.sequence, options.format);
    if (!source->info().has_poses) {
        throw Error("the sequence '", options.sequence, "' has no poses: a trajectory.txt with poses is needed");
    }
    return std::make_unique<sensor::PrefetchSource>(std::move(source));
}

/// Lamps that the main sequence shows are clipped: where they are is known, how bright they are not.
LightEstimationSettings clipped_lamps(LightEstimationSettings settings) {
    settings.find.threshold = kClippedLuminance;
    return settings;
}

Illumination fit(const LightsOptions& options, vulkan::Device& device) {
    const std::unique_ptr<sensor::Source> source = open_main(options, device);
    ReconstructionSettings settings = options.reconstruction;
    if (!settings.reflectance) settings.reflectance.emplace();
    settings.tracking.reset();  // poses are given
    settings.keyframes.reset();
    Reconstruction reconstruction(device, settings);
    LightEstimation estimation(device, clipped_lamps(options.settings));
    const sensor::SequenceInfo& info = source->info();
    for_each_frame(options, *source, "lights", [&](const sensor::Frame& frame) {
        if (!frame.world_from_camera) return;
        const RgbdFrame rgbd = to_rgbd(info, frame);
        reconstruction.add(rgbd);
        estimation.add(rgbd, 1);
    });
    std::vector<glm::vec3> seen_m;
    for (const FoundLight& lamp : estimation.found()) seen_m.push_back(lamp.position_m);
    const FittedLights fitted = fit_lights(reconstruction, seen_m, options.fitting);
    return {"main sequence", fitted.lamps, fitted.ambient, fitted.misfit, fitted.unexplained};
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
FoundPoses located(const LightsOptions& options, const Folders& folders, vulkan::Device& device) {
    const std::string main = main_of(options, folders);
    if (main.empty()) {
        throw Error(
            "the lighting sequence '", folders.lighting.string(),
            "' has no poses, and no main sequence holds it in whose world they could be found: a trajectory.txt "
            "with poses is needed");
    }
    const InterruptGuard interrupt;
    const std::unique_ptr<sensor::Source> room =
        std::make_unique<sensor::PrefetchSource>(sensor::open_sequence(main, options.main_format));
    const std::unique_ptr<sensor::Source> lighting = sensor::open_sequence(folders.lighting);
    LocaliseOptions find{options.reconstruction, options.main_frames, options.track, {}};
    find.on_frame = [&](const char* what, uint32_t done, uint32_t total) {
        if (interrupt.requested())
            throw Interrupted("interrupted after ", done, " of ", total, " frames of the ", what);
    };
    FoundPoses poses = localise(device, *room, *lighting, find);
    if (!options.quiet) {
        const auto count = std::count_if(poses.begin(), poses.end(), [](const auto& pose) { return pose.has_value(); });
        fmt::print("{} of {} frames of '{}' were found in the room of '{}'\n", count, poses.size(),
                   folders.lighting.string(), main);
    }
    return poses;
}

void write(const fs::path& file, const Illumination& found) {
    const fs::path partial = file.string() + ".patina-partial";
    write_lights_json(partial, found);
    std::error_code failure;
    fs::rename(partial, file, failure);
    if (failure) throw Error("the file '", file.string(), "' cannot be written: ", failure.message());
}

void print(const FoundLight& light) {
    fmt::print(
        "{:8.3f} {:8.3f} {:8.3f} m  {:8.3f} {:8.3f} {:8.3f}  radius {:.3f} m  spread {:.1f} mm  {} sightings{}{}\n",
        light.position_m.x, light.position_m.y, light.position_m.z, light.intensity.r, light.intensity.g,
        light.intensity.b, light.radius_m, 1000 * light.spread_m, light.sightings,
        light.has_depth ? "" : ", triangulated", light.clipped > 0 ? ", clipped: brighter than told" : "");
}

}  // namespace

void write_lights_json(const fs::path& file, const Illumination& illumination) {
    std::vector<sensor::PointLight> lights;
    for (const FoundLight& light : illumination.lights)
        lights.push_back({glm::dvec3(light.position_m), glm::dvec3(light.intensity), light.radius_m});
    sensor::write_lights(file, lights, glm::dvec3(illumination.ambient));
}

bool has_lighting_sequence(const std::string& sequence) {
    if (const auto scene = scene_name(sequence))
        return sensor::lighting_sequence(sensor::load_scene(*scene)).has_value();
    const fs::path path(sequence);
    return fs::is_directory((path.filename() == "sequence.json" ? path.parent_path() : path) / "lighting");
}

Illumination find_lights(const LightsOptions& options) {
    const auto scene = scene_name(options.sequence);
    const bool is_one = fs::absolute(options.sequence).lexically_normal().filename() == "lighting";
    const bool low_exposure = options.from == LightsFrom::kLightingSequence ||
                              (options.from == LightsFrom::kAny && (is_one || has_lighting_sequence(options.sequence)));
    std::optional<vulkan::Device> device;  // outlives the source, which may compute on it
    Lighting lighting;
    const Folders folders = scene ? Folders{} : folders_of(options);
    if (low_exposure && !scene) lighting = open_recorded(folders);
    device.emplace(options.device);
    if (low_exposure && !scene && !in_main_world(options, folders, *lighting.source))
        lighting.poses = located(options, folders, *device);
    if (low_exposure && scene) lighting = open_synthetic(*scene, *device);
    const Illumination found = low_exposure ? estimate(options, lighting, *device) : fit(options, *device);
    if (!options.out.empty()) write(options.out, found);
    if (!options.quiet) {
        for (const FoundLight& light : found.lights) print(light);
        if (found.ambient != glm::vec3(0)) {
            fmt::print("ambient {:.4f} {:.4f} {:.4f}\n", found.ambient.r, found.ambient.g, found.ambient.b);
        }
        if (found.lights.empty()) fmt::print("no lamps found\n");
    }
    lighting.source.reset();
    return found;
}

}  // namespace patina::tools
