// patina_segment_bench: how long it takes to divide a frame into segments and to label the map, and pictures of
// segments. See docs/benchmarks.md.
#include <cstdio>
#include <exception>
#include <filesystem>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "engine/core/error.h"
#include "engine/core/shader_camera.h"
#include "passes/segmentation_model.h"
#include "sensor/picture_file.h"
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
    std::string extent = "512x424";
    std::string pictures;
    uint32_t model_frames = 8;
    uint32_t frames = 20;
    uint32_t warmup = 4;
};

/// One colour per segment, black for none: hues a golden angle apart.
Image<sensor::SrgbPixel> in_colors(const Image<uint32_t>& segment) {
    Image<sensor::SrgbPixel> picture(segment.extent());
    for (size_t i = 0; i < segment.pixels().size(); ++i) {
        const uint32_t number = segment.pixels()[i];
        const uint32_t mixed = number * 2654435761u;
        if (number > 0)
            picture.pixels()[i] = {64 + (mixed >> 24) % 192, 64 + (mixed >> 16) % 192, 64 + (mixed >> 8) % 192};
    }
    return picture;
}

/// How much of the segmentation is measured.
enum class Part { kNone, kFrame, kAll };

/// A model that grows frame by frame, with labels, and the segments of the last frame.
class Bench {
  public:
    explicit Bench(vulkan::Device& device)
        : reconstruction_(device, {}),
          access_(preferred_map_access(device.caps(), reconstruction_.map())),
          segmentation_(device, reconstruction_.map(), {}, access_) {}

    void add(const RgbdFrame& rgbd) {
        last_ = rgbd;
        reconstruction_.add(last_);
        graph::Frame frame = runner().begin();
        if (frames_ == 0) segmentation_.reset(frame);
        segmentation_.clear_new_blocks(frame, reconstruction_.map().import(frame));
        runner().submit(std::move(frame));
        measure(1, Part::kAll);
    }

    /// The last frame's segments.
    Image<uint32_t> segments() {
        graph::Frame frame = runner().begin();
        const SegmentationInputs inputs = cast(frame);
        const graph::Readback read = frame.read_back(divided(frame, inputs).segment);
        runner().submit(std::move(frame));
        runner().wait();
        return read.image<uint32_t>();
    }

    /// Processor time of each of `frames` times that the last frame's surface is cast, and segmented.
    std::vector<float> measure(uint32_t frames, Part part) {
        std::vector<float> samples;
        for (uint32_t i = 0; i < frames; ++i) {
            runner().wait();
            const double start = processor_ms();
            graph::Frame frame = runner().begin();
            const SegmentationInputs inputs = cast(frame);
            for (const auto id :
                 {inputs.surface.position_m, inputs.surface.normal, inputs.depth_m, inputs.color_linear})
                frame.keep(id);
            if (part == Part::kFrame) {
                const FrameSegments out = divided(frame, inputs);
                frame.keep(out.segment);
                frame.keep(out.segments);
                frame.keep(out.count);
            } else if (part == Part::kAll) {
                const VoxelMapIds voxels = reconstruction_.map().import(frame);
                frame.keep(segmentation_.add(frame, voxels, inputs, camera(), color_camera(), frames_++));
            }
            runner().submit(std::move(frame));
            runner().wait();
            samples.push_back(static_cast<float>(processor_ms() - start));
        }
        return samples;
    }

    graph::Runner& runner() { return reconstruction_.runner(); }

  private:
    gpu::Camera camera() const { return make_camera(last_.depth.camera, last_.world_from_depth); }
    gpu::Camera color_camera() const {
        return make_camera(last_.color.camera, last_.world_from_depth * rigid_inverse(last_.color_from_depth));
    }

    FrameSegments divided(graph::Frame& frame, const SegmentationInputs& inputs) const {
        return add_segment_frame(frame, inputs.surface.position_m, inputs.depth_m, camera(),
                                 {inputs.color_linear, color_camera()}, segmentation_.settings().frame);
    }

    /// The model as the depth camera sees it, and the last frame's pictures.
    SegmentationInputs cast(graph::Frame& frame) {
        const VoxelMap& map = reconstruction_.map();
        const VoxelMapIds voxels = map.import(frame);
        const float far_m = reconstruction_.settings().fusion.max_depth_m + 0.1f;
        const VisibleBlocks visible = add_visible_blocks(frame, map, voxels, camera(), 0.1f, far_m);
        const RaycastImages model = add_raycast(frame, map, voxels, visible, access_);
        const InputImages input = add_input(frame, last_.depth, last_.color, camera());
        return {{model.position_m, model.normal, visible.view, visible.grid, visible.list},
                input.filtered_depth_m,
                input.color,
                {}};
    }

    Reconstruction reconstruction_;
    MapAccess access_;
    SegmentationModel segmentation_;
    RgbdFrame last_;
    uint32_t frames_ = 0;
};

void print(const std::string& name, const Distribution& d) {
    fmt::print("{:<32} {:>9.3f} {:>9.3f} {:>9.3f}\n", name, d.min, d.median, d.p90);
}

void run(const Options& options) {
    const vulkan::DeviceOptions device_options = options.device.options();
    const Recording recording =
        load({options.sequence, {}, tools::parse_extent(options.extent), options.model_frames}, device_options);
    vulkan::Device device(device_options);
    Bench bench(device);
    if (!options.pictures.empty()) std::filesystem::create_directories(options.pictures);
    for (const sensor::Frame& frame : recording.frames) {
        bench.add(tools::to_rgbd(recording.info, frame));
        if (options.pictures.empty()) continue;
        const auto file = std::filesystem::path(options.pictures) / (sensor::picture_stem(frame.index) + ".png");
        sensor::write_png(file, in_colors(bench.segments()));
    }
    for (const Part part : {Part::kAll, Part::kFrame, Part::kNone}) bench.measure(options.warmup, part);
    bench.runner().clear_timings();
    const Distribution all = distribution(bench.measure(options.frames, Part::kAll));
    const auto timings = bench.runner().pass_timings();
    const Distribution divided = distribution(bench.measure(options.frames, Part::kFrame));
    const Distribution without = distribution(bench.measure(options.frames, Part::kNone));
    fmt::print("{}, {}\n{} at {}, {} frames\n\n", device.caps().name, device.caps().driver, options.sequence,
               options.extent, options.frames);
    fmt::print("{:<32} {:>9} {:>9} {:>9}\n", "ms", "min", "median", "90 %");
    for (const graph::Timing& timing : timings) {
        // The ray cast is a yardstick on a machine that others use too.
        if (timing.name.find("segmentation.") != std::string::npos || timing.name == "fusion.raycast")
            print(timing.name, distribution(timing.samples_ms));
    }
    print("processor time of a frame", all);
    print("the same without labels", divided);
    print("the same without segments", without);
    const auto report = [](const char* name, const Distribution& with, const Distribution& less) {
        fmt::print("{:<32} {:>9.3f} ms on two cores, from the medians' difference\n", name,
                   (with.median - less.median) / 2);
    };
    report("segments of a frame", divided, without);
    report("labels of the map", all, divided);
}

}  // namespace

}  // namespace patina::bench

int main(int argc, char** argv) {
    using namespace patina;
    CLI::App app("Measures how long it takes to divide a frame into segments and to label the map",
                 "patina_segment_bench");
    bench::Options options;
    app.add_option("sequence", options.sequence, "Folder of a sequence, or synthetic:SCENE")->capture_default_str();
    app.add_option("--extent", options.extent, "Resample colour and depth to WIDTHxHEIGHT")->capture_default_str();
    app.add_option("--pictures", options.pictures, "Folder for a picture of each frame's segments");
    app.add_option("--model-frames", options.model_frames, "How many frames to fuse")
        ->capture_default_str()
        ->check(CLI::PositiveNumber);
    app.add_option("--frames", options.frames, "How many times to segment the last one")
        ->capture_default_str()
        ->check(CLI::PositiveNumber);
    app.add_option("--warmup", options.warmup, "How many times before")
        ->capture_default_str()
        ->check(CLI::PositiveNumber);
    options.device.add_to(app);
    CLI11_PARSE(app, argc, argv);
    try {
        bench::run(options);
    } catch (const std::exception& error) {
        fmt::print(stderr, "patina_segment_bench: {}\n", error.what());
        return 1;
    }
    return 0;
}
