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

std::vector<FoundLight> estimate(const LightsOptions& options, const Lighting& lighting, vulkan::Device& device) {
    const InterruptGuard interrupt;
    const sensor::SequenceInfo& info = lighting.source->info();
    const uint32_t frames = options.frames > 0 ? std::min(options.frames, info.frames) : info.frames;
    LightEstimation estimation(device, options.settings);
    Progress progress(frames, options.quiet);
    for (uint32_t done = 0; done < frames; ++done) {
        if (interrupt.requested()) throw Interrupted("interrupted after ", done, " of ", frames, " frames");
        const auto reading = lighting.source->next();
        if (!reading) break;
        if (const auto* skipped = std::get_if<sensor::Skipped>(&*reading)) {
            progress.say(fmt::format("frame {} is skipped: {}", skipped->index, skipped->reason));
        } else if (const auto& frame = std::get<sensor::Frame>(*reading); frame.world_from_camera) {
            const double own = amount(frame.exposure);
            estimation.add(to_rgbd(info, frame), static_cast<float>(lighting.main_exposure.value_or(own) / own));
        }
        progress.update(done + 1, "lamps");
    }
    return estimation.found();
}

void write(const fs::path& file, const std::vector<FoundLight>& found) {
    std::vector<sensor::PointLight> lights;
    for (const FoundLight& light : found)
        lights.push_back({glm::dvec3(light.position_m), glm::dvec3(light.intensity), light.radius_m});
    const fs::path partial = file.string() + ".patina-partial";
    sensor::write_lights(partial, lights);
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

std::vector<FoundLight> find_lights(const LightsOptions& options) {
    const bool synthetic = options.sequence.starts_with(kSynthetic);
    std::optional<vulkan::Device> device;  // outlives the source, which may compute on it
    Lighting lighting;
    if (!synthetic) lighting = open_recorded(options.sequence);
    device.emplace(options.device);
    if (synthetic) lighting = open_synthetic(options.sequence.substr(kSynthetic.size()), *device);
    const std::vector<FoundLight> found = estimate(options, lighting, *device);
    if (!options.out.empty()) write(options.out, found);
    if (!options.quiet) {
        for (const FoundLight& light : found) print(light);
        if (found.empty()) fmt::print("no lamps found\n");
    }
    lighting.source.reset();
    return found;
}

}  // namespace patina::tools
