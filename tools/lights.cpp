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

Lighting open_recorded(const fs::path& folder) {
    const fs::path inside = folder / "lighting", beside = fs::absolute(folder).lexically_normal().parent_path();
    const bool has_inside = fs::is_directory(inside);
    Lighting lighting;
    lighting.source = sensor::open_sequence(has_inside ? inside : folder);
    if (!lighting.source->info().has_poses) {
        throw Error("the lighting sequence '", (has_inside ? inside : folder).string(),
                    "' has no poses: a trajectory.txt with poses is needed");
    }
    if (has_inside) {
        lighting.main_exposure = exposure_of(folder);
    } else if (folder.filename() == "lighting" && fs::exists(beside / "sequence.json")) {
        lighting.main_exposure = exposure_of(beside);
    }
    lighting.source = std::make_unique<sensor::PrefetchSource>(std::move(lighting.source));
    return lighting;
}

Lighting open_synthetic(const std::string& name, vulkan::Device& device) {
    const auto lighting = sensor::lighting_sequence(sensor::load_scene(name));
    if (!lighting)
        throw Error("the scene '", name, "' has no lighting sequence: it needs a path and lamps with a radius");
    const sensor::SyntheticOptions recording{.frames = lighting->frames, .exposure = lighting->exposure};
    return {std::make_unique<sensor::SyntheticSource>(device, lighting->scene, recording), amount({})};
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
        } else if (const auto& frame = std::get<sensor::Frame>(*reading); frame.world_from_camera) {
            take(frame);
        }
        progress.update(done + 1, what);
    }
}

Illumination estimate(const LightsOptions& options, const Lighting& lighting, vulkan::Device& device) {
    const sensor::SequenceInfo& info = lighting.source->info();
    LightEstimation estimation(device, options.settings);
    for_each_frame(options, *lighting.source, "lamps", [&](const sensor::Frame& frame) {
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
    Reconstruction reconstruction(device, settings);
    LightEstimation estimation(device, clipped_lamps(options.settings));
    const sensor::SequenceInfo& info = source->info();
    for_each_frame(options, *source, "lights", [&](const sensor::Frame& frame) {
        const RgbdFrame rgbd = to_rgbd(info, frame);
        reconstruction.add(rgbd);
        estimation.add(rgbd, 1);
    });
    std::vector<glm::vec3> seen_m;
    for (const FoundLight& lamp : estimation.found()) seen_m.push_back(lamp.position_m);
    const FittedLights fitted = fit_lights(reconstruction, seen_m, options.fitting);
    return {"main sequence", fitted.lamps, fitted.ambient, fitted.misfit, fitted.unexplained};
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
    if (low_exposure && !scene) lighting = open_recorded(options.sequence);
    device.emplace(options.device);
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
