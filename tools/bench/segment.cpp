// `patina bench segment`: how long it takes to divide a frame into segments and to label the map, and pictures of
// segments. See docs/develop/benchmarks.md.
#include <filesystem>
#include <memory>

#include <CLI/CLI.hpp>

#include "engine/core/error.h"
#include "reconstruction/pipeline.h"
#include "reconstruction/session/rgbd_frame.h"
#include "reconstruction/stages/segmentation_stage.h"
#include "sensor/files/picture_file.h"
#include "tools/bench/processor_time.h"
#include "tools/bench/recording.h"
#include "tools/bench/subjects.h"

namespace patina::bench {
namespace segment_bench {
namespace {

struct Options {
    std::string sequence = "synthetic:office";
    std::string pictures;
    uint32_t model_frames = 8;
};

/// One colour per segment, black for none: hues a golden angle apart.
Image<SrgbPixel> in_colors(const Image<uint32_t>& segment) {
    Image<SrgbPixel> picture(segment.extent());
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
        : pipeline_(device, {}),
          access_(preferred_map_access(device.caps(), pipeline_.map())),
          segmentation_(device, pipeline_.map(), {}, access_) {}

    void add(const RgbdFrame& rgbd) {
        last_ = rgbd;
        pipeline_.add(last_);
        graph::FrameGraph frame = runner().begin();
        if (frames_ == 0) segmentation_.reset(frame);
        segmentation_.clear_new_blocks(frame, pipeline_.map().import(frame));
        runner().submit(std::move(frame));
        measure(1, Part::kAll);
    }

    /// The last frame's segments.
    Image<uint32_t> segments() {
        graph::FrameGraph frame = runner().begin();
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
            graph::FrameGraph frame = runner().begin();
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
                const VoxelMapIds voxels = pipeline_.map().import(frame);
                frame.keep(segmentation_.add(frame, voxels, inputs, next_context()));
            }
            runner().submit(std::move(frame));
            runner().wait();
            samples.push_back(static_cast<float>(processor_ms() - start));
        }
        return samples;
    }

    graph::Runner& runner() { return pipeline_.runner(); }

  private:
    gpu::Camera camera() const { return make_frame_cameras(last_).depth.gpu; }
    gpu::Camera color_camera() const { return make_frame_cameras(last_).color.gpu; }

    FrameSegments divided(graph::FrameGraph& frame, const SegmentationInputs& inputs) const {
        return add_segment_frame(frame, inputs.surface.position_m, inputs.depth_m, camera(),
                                 {inputs.color_linear, color_camera()}, segmentation_.settings().frame);
    }

    FrameContext next_context() {
        FrameHistory before;
        before.frames = frames_++;
        return make_frame_context(last_, before, {}, true);
    }

    /// The model as the depth camera sees it, and the last frame's pictures.
    SegmentationInputs cast(graph::FrameGraph& frame) {
        const VoxelMap& map = pipeline_.map();
        const VoxelMapIds voxels = map.import(frame);
        const float far_m = pipeline_.settings().fusion.max_depth_m + 0.1f;
        const VisibleBlocks visible = add_visible_blocks(frame, map, voxels, camera(), 0.1f, far_m);
        const RaycastImages model = add_raycast(frame, map, voxels, visible, access_);
        const InputImages input = add_input(frame, last_.depth, last_.color, camera());
        return {surface_of(visible, model), input.filtered_depth_m, input.color, {}};
    }

    Pipeline pipeline_;
    MapAccess access_;
    SegmentationStage segmentation_;
    RgbdFrame last_;
    uint32_t frames_ = 0;
};

/// Fuses the recording, and writes a picture of each frame's segments where the options ask for it.
void fuse(Bench& bench, const Recording& recording, const std::filesystem::path& pictures) {
    if (!pictures.empty()) std::filesystem::create_directories(pictures);
    for (const Frame& frame : recording.frames) {
        bench.add(patina::to_rgbd(recording.info, frame));
        if (pictures.empty()) continue;
        sensor::write_png(pictures / (sensor::picture_stem(frame.index) + ".png"), in_colors(bench.segments()));
    }
}

Report run(const Options& options, const Conditions& conditions) {
    const Recording recording =
        load({options.sequence, {}, conditions.extent, options.model_frames}, conditions.device);
    vulkan::Device device(conditions.device);
    Bench bench(device);
    fuse(bench, recording, options.pictures);
    for (const Part part : {Part::kAll, Part::kFrame, Part::kNone}) bench.measure(conditions.warmup, part);
    bench.runner().clear_timings();
    const Distribution all = distribution(bench.measure(conditions.frames, Part::kAll));
    const auto timings = bench.runner().pass_timings();
    const Distribution divided = distribution(bench.measure(conditions.frames, Part::kFrame));
    const Distribution without = distribution(bench.measure(conditions.frames, Part::kNone));
    std::vector<Row> rows;
    for (const graph::Timing& timing : timings) {
        // The ray cast is a yardstick on a machine that others use too.
        if (timing.name.find("segmentation.") != std::string::npos || timing.name == "fusion.raycast")
            rows.push_back({timing.name, distribution(timing.samples_ms)});
    }
    rows.push_back({"processor time of a frame", all});
    rows.push_back({"the same without labels", divided});
    rows.push_back({"the same without segments", without});
    const Extent2D extent = recording.info.depth.extent;
    Report report(device.caps());
    report.print("{} at {}x{}, {} frames\n\n", options.sequence, extent.width, extent.height, conditions.frames);
    report.table("ms", rows);
    report.difference("segments of a frame", divided, without);
    report.difference("labels of the map", all, divided);
    return report;
}

}  // namespace
}  // namespace segment_bench

Subject segment_subject() {
    using namespace segment_bench;
    return {"segment",
            "How long it takes to divide a frame into segments and to label the map",
            {.warmup = 4, .frames = 20, .extent = "512x424"},
            [](CLI::App& app) -> Measure {
                const auto options = std::make_shared<Options>();
                app.add_option("sequence", options->sequence, "Folder of a sequence, or synthetic:SCENE")
                    ->capture_default_str();
                app.add_option("--pictures", options->pictures, "Folder for a picture of each frame's segments");
                app.add_option("--model-frames", options->model_frames, "How many frames to fuse first")
                    ->capture_default_str()
                    ->check(CLI::PositiveNumber);
                return [options](const Conditions& conditions) { return run(*options, conditions); };
            }};
}

}  // namespace patina::bench
