// `patina bench kinect2`: how long it takes to decode a Kinect v2's infrared frames. See docs/develop/benchmarks.md.
#include <algorithm>
#include <memory>

#include <CLI/CLI.hpp>

#include "engine/core/error.h"
#include "engine/graph/runner.h"
#include "passes/kinect2/decode.h"
#include "passes/kinect2/register_color.h"
#include "scenes/kinect2/infrared_frame.h"
#include "tools/bench/processor_time.h"
#include "tools/bench/recording.h"
#include "tools/bench/subjects.h"

namespace patina::bench {
namespace kinect2_bench {
namespace {

constexpr double kWhiteAmplitude = 2000;  // of a white surface 1 m away; a grey wall 4 m away is left with 60

struct Options {
    std::string sequence = "synthetic:office";
    bool base2 = false;
};

/// A Kinect v2 with the numbers that devices have; phase offsets vary smoothly over the picture.
kinect2::CameraModel typical_camera() {
    kinect2::CameraModel model;
    model.depth = {kinect2::kInfraredExtent, 365.4, 365.4, 260.4, 205.1, {0.0956, -0.277, 0, 0, 0.0975}};
    // A colour camera with the same lens: a ray of one pixel in the depth picture is 1 / 365.4.
    model.color = {1081.372, 959.5, 539.5, 863, 52, {}, {}};
    model.color.mx[7] = model.color.my[8] = 0.65;
    model.color.mx[9] = 0.143;
    for (uint32_t f = 0; f < 3; ++f) {
        for (uint32_t i = 0; i < kinect2::kInfraredExtent.area(); ++i)
            model.p0[f].push_back(static_cast<uint16_t>(9000 * (f + 1) + 3 * (i % 512) + 5 * (i / 512)));
    }
    return model;
}

/// What the sensor sends of a frame's depth, under its own light.
std::vector<uint8_t> simulate(const kinect2::CameraModel& model, const Recording& recording) {
    const auto& pixels = std::get<Image<uint16_t>>(recording.frames.front().depth);
    Image<float> picture(pixels.extent());
    for (size_t i = 0; i < picture.pixels().size(); ++i)
        picture.pixels()[i] = static_cast<float>(pixels.pixels()[i] * recording.info.metres_per_unit);
    const Image<float> depth_m = scenes::kinect2::as_transmitted(model.depth, picture, recording.info.depth);
    const Image<float> amplitude =
        scenes::kinect2::lit_amplitude(depth_m, Image<float>(depth_m.extent(), 0.5f), kWhiteAmplitude);
    return scenes::kinect2::infrared_frame({model.depth, model.p0}, {depth_m, amplitude}, {25, 1, 1});
}

/// A frame that is decoded again and again.
class Bench {
  public:
    Bench(vulkan::Device& device, const Options& options, const Recording& recording)
        : runner_(device),
          tables_(device, typical_camera()),
          infrared_(simulate(typical_camera(), recording)),
          color_(kinect2::kColorExtent, SrgbPixel(90, 100, 110)) {
        if (options.base2) settings_.exponentials = kinect2::Exponentials::kBase2;
    }

    /// Processor time of each of `frames` times, with the passes or with the transfers alone.
    std::vector<float> measure(uint32_t frames, bool passes) {
        std::vector<float> samples;
        for (uint32_t i = 0; i < frames; ++i) {
            const double start = processor_ms();
            if (passes) {
                depth_ = decode();
            } else {
                transfer();
            }
            samples.push_back(static_cast<float>(processor_ms() - start));
        }
        return samples;
    }

    size_t readings() const {
        const auto depth_m = depth_.as<float>();
        return static_cast<size_t>(std::count_if(depth_m.begin(), depth_m.end(), [](float z) { return z > 0; }));
    }

    graph::Runner& runner() { return runner_; }

  private:
    graph::Readback decode() {
        graph::FrameGraph frame = runner_.begin();
        const kinect2::TableIds tables = tables_.import(frame);
        const auto images = kinect2::add_decode(frame, tables, infrared_, settings_);
        frame.keep(images.infrared);
        frame.keep(kinect2::add_register_color(frame, tables_, tables, images.depth_m, color_.pixels()));
        const graph::Readback depth_m = frame.read_back(images.depth_m);
        runner_.submit(std::move(frame));
        runner_.wait();
        return depth_m;
    }

    /// What goes to the device for a frame and comes back.
    void transfer() {
        graph::FrameGraph frame = runner_.begin();
        frame.keep(frame.upload("kinect2.codes", std::span<const uint8_t>(infrared_)));
        frame.keep(frame.upload("kinect2.color", std::span<const SrgbPixel>(color_.pixels())));
        const std::vector<float> depth_m(kinect2::kInfraredExtent.area());
        frame.read_back(frame.upload("kinect2.depth", std::span<const float>(depth_m)));
        runner_.submit(std::move(frame));
        runner_.wait();
    }

    graph::Runner runner_;
    kinect2::Tables tables_;
    kinect2::DecodeSettings settings_;
    std::vector<uint8_t> infrared_;
    Image<SrgbPixel> color_;
    graph::Readback depth_;
};

/// What the passes took in each frame together.
std::vector<float> sums(const std::vector<graph::Timing>& timings, uint32_t frames) {
    std::vector<float> sum(frames);
    for (const graph::Timing& timing : timings) {
        if (!timing.name.starts_with("kinect2.") || timing.samples_ms.size() != frames) continue;
        for (uint32_t i = 0; i < frames; ++i) sum[i] += timing.samples_ms[i];
    }
    return sum;
}

Report run(const Options& options, const Conditions& conditions) {
    const Recording recording = load({options.sequence, {}, kinect2::kInfraredExtent, 1}, conditions.device);
    if (!std::holds_alternative<Image<uint16_t>>(recording.frames.front().depth))
        throw Error(options.sequence, " has depth in floats; the bench needs integer depth");
    vulkan::Device device(conditions.device);
    Bench bench(device, options, recording);
    bench.measure(conditions.warmup, false);
    bench.measure(conditions.warmup, true);
    bench.runner().clear_timings();
    const Distribution all = distribution(bench.measure(conditions.frames, true));
    const auto timings = bench.runner().pass_timings();
    const Distribution none = distribution(bench.measure(conditions.frames, false));
    std::vector<Row> rows;
    for (const graph::Timing& timing : timings) rows.push_back({timing.name, distribution(timing.samples_ms)});
    rows.push_back({"all passes of a frame", distribution(sums(timings, conditions.frames))});
    rows.push_back({"processor time of a frame", all});
    rows.push_back({"the same, transfers alone", none});
    Report report(device.caps());
    report.print("{} as a Kinect v2 sends it, {} frames; depth at {:.1f} % of the pixels\n\n", options.sequence,
                 conditions.frames,
                 100.0 * static_cast<double>(bench.readings()) / static_cast<double>(kinect2::kInfraredExtent.area()));
    report.table("ms", rows);
    report.difference("decoding and registration", all, none);
    return report;
}

}  // namespace
}  // namespace kinect2_bench

Subject kinect2_subject() {
    using namespace kinect2_bench;
    return {"kinect2",
            "How long decoding and registration of a Kinect v2's frames take",
            {.warmup = 4, .frames = 40},
            [](CLI::App& app) -> Measure {
                const auto options = std::make_shared<Options>();
                app.add_option("sequence", options->sequence,
                               "Folder of a sequence, or synthetic:SCENE, whose first frame is simulated")
                    ->capture_default_str();
                app.add_flag("--base2", options->base2, "Exponentials as the constants mean, not as libfreenect2");
                return [options](const Conditions& conditions) { return run(*options, conditions); };
            }};
}

}  // namespace patina::bench
