#include "tools/synth/synth.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <system_error>
#include <variant>
#include <vector>

#include <fmt/format.h>

#include "engine/core/printable.h"
#include "scenes/description/lighting_sequence.h"
#include "scenes/description/never_recorded.h"
#include "scenes/description/noise.h"
#include "scenes/render/environment.h"
#include "scenes/render/synthetic_source.h"
#include "sensor/files/picture_file.h"
#include "sensor/pose.h"
#include "sensor/truth.h"
#include "sensor/write_sequence.h"
#include "tools/program/interrupt.h"
#include "tools/program/progress.h"
#include "tools/program/standard_streams.h"
#include "tools/synth/truth_frame.h"

namespace patina::tools {
namespace {

namespace fs = std::filesystem;

/// A preset's errors of depth and colour; those of poses stay.
scenes::SensorNoise with_preset(const scenes::SensorNoise& noise, const std::string& name) {
    scenes::SensorNoise changed = scenes::noise_preset(name);
    changed.pose_translation_m = noise.pose_translation_m;
    changed.pose_rotation_rad = noise.pose_rotation_rad;
    return changed;
}

void set_extent(scenes::SyntheticScene& scene, Extent2D extent) {
    const Extent2D before = scene.camera.extent;
    scene.camera = scaled_to(scene.camera, extent);
    if (!scene.color_camera) return;
    Intrinsics& color = scene.color_camera->camera;
    const auto scaled = [](uint32_t size, uint32_t to, uint32_t from) {
        return std::max(1u, static_cast<uint32_t>(std::lround(static_cast<double>(size) * to / from)));
    };
    color = scaled_to(color, {scaled(color.extent.width, extent.width, before.width),
                              scaled(color.extent.height, extent.height, before.height)});
}

scenes::SyntheticScene scene_of(const SynthOptions& options) {
    scenes::SyntheticScene scene = scenes::load_scene(options.scene, options.changes);
    scenes::Recording& recording = scene.recording;
    if (options.noise) recording.noise = with_preset(recording.noise, *options.noise);
    if (options.pose_noise) {
        recording.noise.pose_translation_m = options.pose_noise->translation_m;
        recording.noise.pose_rotation_rad = options.pose_noise->rotation_degrees * std::numbers::pi / 180;
    }
    recording.render.shadows = options.shadows.value_or(recording.render.shadows);
    recording.render.area_lights = options.area_lights.value_or(recording.render.area_lights);
    recording.render.bounces = options.bounces.value_or(recording.render.bounces);
    recording.render.samples = options.samples.value_or(recording.render.samples);
    if (options.environment) {
        scene.environment = {std::make_shared<Image<glm::vec3>>(scenes::read_environment(*options.environment))};
    }
    recording.exr = options.exr.value_or(recording.exr);
    if (options.extent) set_extent(scene, *options.extent);
    return scene;
}

void create_folder(const fs::path& folder) {
    std::error_code failure;
    fs::create_directories(folder, failure);
    if (failure) throw Error(folder.string(), " cannot be created: ", failure.message());
}

/// Counts frames over all sequences of one command, and stops where the user wants.
class Watch {
  public:
    Watch(const SynthOptions& options, uint32_t frames)
        : out_(options.out), frames_(frames), progress_("Rendering", frames, options.quiet) {}

    void frame_done(const std::string& sequence) {
        progress_.update(++done_, sequence);
        if (interrupt_.requested()) {
            throw Interrupted("interrupted after ", done_, " of ", frames_, " frames; nothing is left in '",
                              out_.string(), "'");
        }
    }

  private:
    const fs::path& out_;
    uint32_t frames_;
    uint32_t done_ = 0;
    Progress progress_;
    InterruptGuard interrupt_;
};

/// Writes what is true of a source's frames into the folder that a writer fills. The source outlives the writer.
class TruthWriter {
  public:
    TruthWriter(sensor::SequenceWriter& writer, const scenes::SyntheticSource& source, bool frames)
        : folder_(writer.partial_folder() / "truth"), writer_(writer), source_(source) {
        create_folder(folder_ / "labels");
        if (frames) create_folder(folder_ / "frames");
        sensor::write_lights(folder_ / "lights.json", source.scene().lights);
        sensor::write_materials(folder_ / "materials.json", scenes::materials_of(source.scene()));
    }

    /// Of the source's last frame.
    void write(uint32_t index, double timestamp_s) {
        const scenes::FrameTruth& truth = source_.truth();
        const std::string stem = sensor::picture_stem(index);
        poses_.push_back({timestamp_s, truth.world_from_camera});
        writer_.background().start(
            [file = folder_ / "labels" / (stem + ".png"), labels = truth.labels] { sensor::write_png(file, labels); });
        if (!truth.seen) return;
        writer_.background().start(
            [file = folder_ / "frames" / (stem + ".exr"), seen = *truth.seen, &scene = source_.scene()] {
                write_exr(file, channels_of(truth_dump(scene, seen)));
            });
    }

    void finish() const { sensor::write_trajectory(folder_ / "trajectory.txt", poses_); }

  private:
    fs::path folder_;
    sensor::SequenceWriter& writer_;
    const scenes::SyntheticSource& source_;
    std::vector<sensor::StampedPose> poses_;
};

sensor::LinearColor linear_color_of(const scenes::SyntheticScene& scene) {
    return scene.recording.exr ? sensor::LinearColor::kExr : sensor::LinearColor::kPng;
}

/// Records a source from its first to its last frame into a writer's folder.
void record(scenes::SyntheticSource& source, sensor::SequenceWriter& writer, bool truth_frames, Watch& watch,
            const std::string& name) {
    TruthWriter truth(writer, source, truth_frames);
    while (auto reading = source.next()) {
        auto& frame = std::get<Frame>(*reading);
        truth.write(frame.index, frame.timestamp_s);
        writer.write(std::move(frame));
        watch.frame_done(name);
    }
    truth.finish();
}

/// Views that the main sequence never has, with the truth of each.
void record_never_recorded(vulkan::Device& device, const scenes::SyntheticScene& scene, uint32_t views,
                           const fs::path& folder, Watch& watch) {
    scenes::SyntheticSource source(device, scene, {.frames = views, .truth_every = 1});
    sensor::SequenceWriter writer(folder, source.info(), linear_color_of(scene));
    record(source, writer, true, watch, folder.filename().string());
    writer.finish();
}

}  // namespace

void synthesise(vulkan::Device& device, const SynthOptions& options) {
    const scenes::SyntheticScene scene = scene_of(options);
    const auto lighting = options.lighting ? scenes::lighting_sequence(scene) : std::nullopt;
    scenes::SyntheticSource source(device, scene, {.frames = options.frames, .truth_every = options.truth_every});
    // Before the first folder and until the last is gone, so that an interruption leaves none.
    Watch watch(options, options.frames + (lighting ? lighting->frames : 0) + 2 * options.novel);
    sensor::SequenceWriter writer(options.out, source.info(), linear_color_of(scene));
    record(source, writer, options.truth_every > 0, watch, scene.name);
    if (lighting) {
        scenes::SyntheticSource dark(device, lighting->scene,
                                     {.frames = lighting->frames, .exposure = lighting->exposure});
        sensor::SequenceWriter dark_writer(writer.partial_folder() / "lighting", dark.info(), linear_color_of(scene));
        record(dark, dark_writer, false, watch, "lighting");
        dark_writer.finish();
    }
    if (options.novel > 0) {
        const auto novel = scenes::with_novel_views(scene, options.novel, options.frames / scene.fps);
        const fs::path truth = writer.partial_folder() / "truth";
        record_never_recorded(device, novel, options.novel, truth / "novel", watch);
        record_never_recorded(device, scenes::with_other_light(novel), options.novel, truth / "relit", watch);
    }
    writer.finish();
    if (!options.quiet)
        print_out("{} frames of {} in {}\n", options.frames, printable(scene.name), printable(options.out.string()));
}

}  // namespace patina::tools
