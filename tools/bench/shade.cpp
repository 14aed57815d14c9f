// `patina bench shade`: how long re-rendering takes, on the model of a recording. See docs/develop/benchmarks.md.

#include <memory>

#include <CLI/CLI.hpp>

#include "engine/core/error.h"
#include "passes/fusion/measure_slope.h"
#include "passes/fusion/shade_color.h"
#include "passes/fusion/sharpen_normals.h"
#include "passes/observation/observation.h"
#include "passes/reflectance/average_segments.h"
#include "passes/reflectance/reflectance.h"
#include "passes/shading/predict_radiance.h"
#include "passes/shading/restore_detail.h"
#include "reconstruction/frame_context.h"
#include "reconstruction/session/rgbd_frame.h"
#include "tools/bench/processor_time.h"
#include "tools/bench/recording.h"
#include "tools/bench/subjects.h"

namespace patina::bench {
namespace shade_bench {
namespace {

struct Options {
    std::string sequence = "synthetic:office";
    float voxel_m = 0.02f;
    uint32_t lights = 4;
    uint32_t model_frames = 8;
};

ObservationMapSettings map_settings(float voxel_m) {
    ObservationMapSettings settings;
    settings.voxel_m = voxel_m;
    return settings;
}

/// A recording's model with reflectance under lamps that are made up.
class Bench {
  public:
    Bench(vulkan::Device& device, const Options& options, const Recording& recording)
        : device_(device),
          pipeline_(device, {}),
          records_(device, map_settings(options.voxel_m)),
          materials_(device, 2),
          state_(device, records_) {
        set_lights(options.lights);
        materials_.set(1, glm::vec3(0.1f), 0.2f);
        for (const Frame& frame : recording.frames) {
            last_ = patina::to_rgbd(recording.info, frame);
            pipeline_.add(last_);
            if (&frame == &recording.frames.front()) reset();
            collect();
        }
        refine();
    }

    /// How many pixels of a view have a known kd.
    size_t known_pixels() {
        const graph::Readback rgb = cast(true, true);
        runner().wait();
        size_t known = 0;
        for (const uint64_t pixel : rgb.as<uint64_t>()) known += pixel >> 48 != 0;
        return known;
    }

    /// Processor time of each of `frames` casts, with or without the shading.
    std::vector<float> measure(uint32_t frames, bool shade) {
        std::vector<float> samples;
        for (uint32_t i = 0; i < frames; ++i) {
            runner().wait();
            const double start = processor_ms();
            cast(shade);
            runner().wait();
            samples.push_back(static_cast<float>(processor_ms() - start));
        }
        return samples;
    }

    graph::Runner& runner() { return pipeline_.runner(); }

  private:
    void set_lights(uint32_t count) {
        std::vector<Light> lamps;
        for (uint32_t i = 0; i < count; ++i) {
            const float x = 2.0f * static_cast<float>(i % 8) - 4.0f, z = 2.0f * static_cast<float>(i / 8) - 4.0f;
            lamps.push_back({{x, -2.2f, z}, glm::dvec3(3), 0.05f});
        }
        lights_.set(lamps, glm::dvec3(0.05f));
    }

    void reset() {
        graph::FrameGraph frame = runner().begin();
        records_.reset(frame, glm::dvec3(last_.world_from_depth[3]));
        state_.reset(frame);
        runner().submit(std::move(frame));
    }

    gpu::Camera camera() const { return make_frame_cameras(last_).depth.gpu; }
    gpu::Camera color_camera() const { return make_frame_cameras(last_).color.gpu; }
    const VoxelMap& map() const { return pipeline_.map(); }
    VisibleBlocks visible(graph::FrameGraph& frame, const VoxelMapIds& voxels) {
        const float far_m = pipeline_.settings().fusion.max_depth_m + 0.1f;
        return add_visible_blocks(frame, map(), voxels, camera(), 0.1f, far_m);
    }
    MapAccess access() const { return preferred_map_access(device_.caps(), map()); }

    void collect() {
        graph::FrameGraph frame = runner().begin();
        const VoxelMapIds voxels = map().import(frame);
        ObservationMapIds ids = records_.import(frame);
        const RaycastImages model = add_raycast(frame, map(), voxels, visible(frame, voxels), access());
        const InputImages input = add_input(frame, last_.depth, last_.color, camera());
        const Extent2D extent = last_.depth.camera.extent;
        const std::vector<uint32_t> labels(extent.area(), 1);
        const ObservationInputs inputs{
            model.position_m,
            model.normal,
            input.depth_m,
            add_measure_slope(frame, input.filtered_depth_m, last_.depth.camera),
            input.color,
            frame.upload("labels", {extent, vulkan::Format::kR32u}, std::as_bytes(std::span(labels)))};
        ObservationSettings settings;
        settings.stride_px = 1;
        add_collect_observations(frame, records_, ids, inputs, settings, camera(), color_camera(), collected_++);
        ObservationMap::keep(frame, ids);
        runner().submit(std::move(frame));
    }

    void refine() {
        graph::FrameGraph frame = runner().begin();
        ObservationMapIds ids = records_.import(frame);
        add_refine_all_reflectance(frame, {map(), records_, lights_, materials_, state_}, map().import(frame), ids,
                                   preferred_reflectance_access(device_.caps(), map(), records_), {});
        ObservationMap::keep(frame, ids);
        runner().submit(std::move(frame));
    }

    /// With shading, or without it; what shading reads is there in both.
    graph::Readback cast(bool shade, bool read_back = false) {
        graph::Readback rgb;
        graph::FrameGraph frame = runner().begin();
        const VoxelMapIds voxels = map().import(frame);
        const VisibleBlocks blocks = visible(frame, voxels);
        const RaycastImages model = add_raycast(frame, map(), voxels, blocks, access());
        const graph::ImageId color = add_shade_color(frame, map(), voxels, blocks, model.position_m);
        for (const graph::ImageId image : {model.position_m, model.normal, color}) frame.keep(image);
        if (shade) {
            const PredictedImages seen = predict(frame, voxels, blocks, model, color);
            for (const graph::ImageId image : {seen.kd, seen.label, seen.ks_alpha, seen.rgb}) frame.keep(image);
            if (read_back) rgb = frame.read_back(seen.rgb);
        }
        runner().submit(std::move(frame));
        return rgb;
    }

    PredictedImages predict(graph::FrameGraph& frame, const VoxelMapIds& voxels, const VisibleBlocks& blocks,
                            const RaycastImages& model, graph::ImageId color) {
        const auto focal_px = static_cast<float>(last_.depth.camera.fx);
        const RaycastImages sharp = add_sharpen_normals(frame, model, focal_px, map().settings().voxel_m);
        const PredictedImages predicted = add_predict_radiance(
            frame, map(), voxels, records_, records_.import(frame), state_.import(frame),
            {sharp.position_m, sharp.normal, blocks.view, blocks.grid, lights_.upload(frame), materials_.import(frame),
             add_average_segments(frame, records_, records_.import(frame), materials_.capacity()),
             materials_.capacity(), static_cast<uint32_t>(lights_.point_lights().size()), true, access()});
        return add_restore_detail(frame, predicted,
                                  {sharp.position_m, sharp.normal, color, focal_px, records_.settings().voxel_m});
    }

    vulkan::Device& device_;
    Pipeline pipeline_;
    ObservationMap records_;
    Lights lights_;
    SegmentMaterials materials_;
    ReflectanceState state_;
    RgbdFrame last_;
    uint32_t collected_ = 0;
};

Report run(const Options& options, const Conditions& conditions) {
    const Recording recording =
        load({options.sequence, {}, conditions.extent, options.model_frames}, conditions.device);
    const Extent2D extent = recording.info.depth.extent;
    vulkan::Device device(conditions.device);
    Bench bench(device, options, recording);
    const size_t known = bench.known_pixels();
    bench.measure(conditions.warmup, true);
    bench.measure(1, false);
    bench.runner().clear_timings();
    const Distribution with = distribution(bench.measure(conditions.frames, true));
    const auto timings = bench.runner().pass_timings();
    const Distribution without = distribution(bench.measure(conditions.frames, false));
    std::vector<Row> rows;
    for (const graph::Timing& timing : timings) {
        if (timing.name.starts_with("shading.") || timing.name == "fusion.sharpen_normals")
            rows.push_back({timing.name, distribution(timing.samples_ms)});
    }
    rows.push_back({"processor time of a view", with});
    rows.push_back({"the same without shading", without});
    Report report(device.caps());
    report.print("{} at {}x{}, {} m, {} lights, {} frames; kd known at {:.1f} % of the pixels\n\n", options.sequence,
                 extent.width, extent.height, options.voxel_m, options.lights, conditions.frames,
                 100.0 * static_cast<double>(known) / static_cast<double>(extent.area()));
    report.table("ms", rows);
    report.difference("shading", with, without);
    return report;
}

}  // namespace
}  // namespace shade_bench

Subject shade_subject() {
    using namespace shade_bench;
    return {"shade",
            "How long the re-rendering of a view takes, on the model of a recording",
            {.warmup = 4, .frames = 20, .extent = "512x424"},
            [](CLI::App& app) -> Measure {
                const auto options = std::make_shared<Options>();
                app.add_option("sequence", options->sequence, "Folder of a sequence, or synthetic:SCENE")
                    ->capture_default_str();
                app.add_option("--voxel", options->voxel_m, "Size of the observations' voxels, 0.02 or 0.01 m")
                    ->capture_default_str();
                app.add_option("--lights", options->lights, "Point lights")
                    ->capture_default_str()
                    ->check(CLI::Range(0u, gpu::kMaxPointLights));
                app.add_option("--model-frames", options->model_frames, "How many frames to fuse and observe first")
                    ->capture_default_str()
                    ->check(CLI::PositiveNumber);
                return [options](const Conditions& conditions) { return run(*options, conditions); };
            }};
}

}  // namespace patina::bench
