// patina_shade_bench: how long re-rendering takes, on the model of a recording. See docs/benchmarks.md.
#include <cstdio>
#include <exception>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "engine/core/error.h"
#include "engine/core/shader_camera.h"
#include "passes/fusion/measure_slope.h"
#include "passes/fusion/shade_color.h"
#include "passes/fusion/sharpen_normals.h"
#include "passes/observation/observation.h"
#include "passes/reflectance/average_segments.h"
#include "passes/reflectance/reflectance.h"
#include "passes/shading/predict_radiance.h"
#include "passes/shading/restore_detail.h"
#include "tools/bench/distribution.h"
#include "tools/bench/processor_time.h"
#include "tools/bench/recording.h"
#include "tools/commands/commands.h"
#include "tools/commands/parse.h"
#include "tools/rgbd_frame.h"

namespace patina::bench {

namespace {

struct Options {
    tools::DeviceArguments device;
    std::string sequence = "synthetic:office";
    float voxel_m = 0.02f;
    std::string extent = "512x424";
    uint32_t lights = 4;
    uint32_t model_frames = 8;
    uint32_t frames = 20;
    uint32_t warmup = 4;
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
          reconstruction_(device, {}),
          records_(device, map_settings(options.voxel_m)),
          materials_(device, 2),
          state_(device, records_) {
        set_lights(options.lights);
        materials_.set(1, glm::vec3(0.1f), 0.2f);
        for (const sensor::Frame& frame : recording.frames) {
            last_ = tools::to_rgbd(recording.info, frame);
            reconstruction_.add(last_);
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

    graph::Runner& runner() { return reconstruction_.runner(); }

  private:
    void set_lights(uint32_t count) {
        std::vector<PointLight> lamps;
        for (uint32_t i = 0; i < count; ++i) {
            const float x = 2.0f * static_cast<float>(i % 8) - 4.0f, z = 2.0f * static_cast<float>(i / 8) - 4.0f;
            lamps.push_back({{x, -2.2f, z}, glm::vec3(3), 0.05f});
        }
        lights_.set(lamps, glm::vec3(0.05f));
    }

    void reset() {
        graph::Frame frame = runner().begin();
        records_.reset(frame, glm::dvec3(last_.world_from_depth[3]));
        state_.reset(frame);
        runner().submit(std::move(frame));
    }

    gpu::Camera camera() const { return make_camera(last_.depth.camera, last_.world_from_depth); }
    const VoxelMap& map() const { return reconstruction_.map(); }
    VisibleBlocks visible(graph::Frame& frame, const VoxelMapIds& voxels) {
        const float far_m = reconstruction_.settings().fusion.max_depth_m + 0.1f;
        return add_visible_blocks(frame, map(), voxels, camera(), 0.1f, far_m);
    }
    MapAccess access() const { return preferred_map_access(device_.caps(), map()); }

    void collect() {
        graph::Frame frame = runner().begin();
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
        const gpu::Camera color_camera =
            make_camera(last_.color.camera, last_.world_from_depth * rigid_inverse(last_.color_from_depth));
        ObservationSettings settings;
        settings.stride_px = 1;
        add_collect_observations(frame, records_, ids, inputs, settings, camera(), color_camera, collected_++);
        ObservationMap::keep(frame, ids);
        runner().submit(std::move(frame));
    }

    void refine() {
        graph::Frame frame = runner().begin();
        ObservationMapIds ids = records_.import(frame);
        add_refine_all_reflectance(frame, {map(), records_, lights_, materials_, state_}, map().import(frame), ids,
                                   preferred_reflectance_access(device_.caps(), map(), records_), {});
        ObservationMap::keep(frame, ids);
        runner().submit(std::move(frame));
    }

    /// With shading, or without it; what shading reads is there in both.
    graph::Readback cast(bool shade, bool read_back = false) {
        graph::Readback rgb;
        graph::Frame frame = runner().begin();
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

    PredictedImages predict(graph::Frame& frame, const VoxelMapIds& voxels, const VisibleBlocks& blocks,
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
    Reconstruction reconstruction_;
    ObservationMap records_;
    Lights lights_;
    SegmentMaterials materials_;
    ReflectanceState state_;
    RgbdFrame last_;
    uint32_t collected_ = 0;
};

void print(const std::string& name, const Distribution& d) {
    fmt::print("{:<32} {:>9.3f} {:>9.3f} {:>9.3f}\n", name, d.min, d.median, d.p90);
}

void run(const Options& options) {
    const Extent2D extent = tools::parse_extent(options.extent);
    const vulkan::DeviceOptions device_options = options.device.options();
    const Recording recording = load({options.sequence, {}, extent, options.model_frames}, device_options);
    vulkan::Device device(device_options);
    Bench bench(device, options, recording);
    const size_t known = bench.known_pixels();
    bench.measure(options.warmup, true);
    bench.measure(1, false);
    bench.runner().clear_timings();
    const Distribution with = distribution(bench.measure(options.frames, true));
    const auto timings = bench.runner().pass_timings();
    const Distribution without = distribution(bench.measure(options.frames, false));
    fmt::print("{}, {}\n{} at {}, {} m, {} lights, {} frames; kd known at {:.1f} % of the pixels\n\n",
               device.caps().name, device.caps().driver, options.sequence, options.extent, options.voxel_m,
               options.lights, options.frames, 100.0 * static_cast<double>(known) / static_cast<double>(extent.area()));
    fmt::print("{:<32} {:>9} {:>9} {:>9}\n", "ms", "min", "median", "90 %");
    for (const graph::Timing& timing : timings) {
        if (timing.name.starts_with("shading.") || timing.name == "fusion.sharpen_normals")
            print(timing.name, distribution(timing.samples_ms));
    }
    print("processor time of a view", with);
    print("the same without shading", without);
    fmt::print("{:<32} {:>9.3f} ms on two cores, from the medians' difference\n", "shading",
               (with.median - without.median) / 2);
}

}  // namespace

}  // namespace patina::bench

int main(int argc, char** argv) {
    using namespace patina;
    CLI::App app("Measures how long re-rendering takes", "patina_shade_bench");
    bench::Options options;
    app.add_option("sequence", options.sequence, "Folder of a sequence, or synthetic:SCENE")->capture_default_str();
    app.add_option("--extent", options.extent, "Resample colour and depth to WIDTHxHEIGHT")->capture_default_str();
    app.add_option("--voxel", options.voxel_m, "Size of the observations' voxels, 0.02 or 0.01 m")
        ->capture_default_str();
    app.add_option("--lights", options.lights, "Point lights")
        ->capture_default_str()
        ->check(CLI::Range(0u, gpu::kMaxPointLights));
    app.add_option("--model-frames", options.model_frames, "How many frames to fuse and observe")
        ->capture_default_str()
        ->check(CLI::PositiveNumber);
    app.add_option("--frames", options.frames, "How many views to measure")
        ->capture_default_str()
        ->check(CLI::PositiveNumber);
    app.add_option("--warmup", options.warmup, "How many to run before")
        ->capture_default_str()
        ->check(CLI::PositiveNumber);
    options.device.add_to(app);
    CLI11_PARSE(app, argc, argv);
    try {
        bench::run(options);
    } catch (const std::exception& error) {
        fmt::print(stderr, "patina_shade_bench: {}\n", error.what());
        return 1;
    }
    return 0;
}
