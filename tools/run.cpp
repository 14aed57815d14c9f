#include "tools/run.h"

#include <algorithm>
#include <chrono>
#include <fstream>
#include <optional>

#include <fmt/format.h>

#include "engine/graph/plan/plan.h"
#include "sensor/ledger.h"
#include "sensor/open.h"
#include "sensor/prefetch.h"
#include "sensor/synthetic/scene_file.h"
#include "sensor/synthetic/synthetic_source.h"
#include "tools/export/report.h"
#include "tools/export/run_record.h"
#include "tools/export/trajectory.h"
#include "tools/export/write_glb.h"
#include "tools/frame_dumps.h"
#include "tools/held_out.h"
#include "tools/interrupt.h"
#include "tools/lights.h"
#include "tools/progress.h"
#include "tools/rgbd_frame.h"
#include "tools/run_settings.h"
#include "tools/run_truth.h"
#include "tools/version.h"

namespace patina::tools {

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::string_view kSynthetic = "synthetic:";
constexpr uint32_t kSyntheticFrames = 120;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

bool is_synthetic(const RunOptions& options) { return options.sequence.starts_with(kSynthetic); }

/// A recording is opened before the device, so that a wrong path is told at once.
std::unique_ptr<sensor::Source> open_recording(const RunOptions& options) {
    auto source = sensor::open_sequence(options.sequence, options.format);
    if (!source->info().has_poses) {
        throw Error(
            "the sequence '", options.sequence,
            "' has no poses, and tracking the camera is not supported yet: a trajectory.txt with poses is needed");
    }
    return std::make_unique<sensor::PrefetchSource>(std::move(source));
}

std::unique_ptr<sensor::SyntheticSource> open_synthetic(const RunOptions& options, vulkan::Device& device) {
    const uint32_t frames = options.frames > 0 ? options.frames : kSyntheticFrames;
    return std::make_unique<sensor::SyntheticSource>(device,
                                                     sensor::load_scene(options.sequence.substr(kSynthetic.size())),
                                                     sensor::SyntheticOptions{.frames = frames});
}

/// The lights that the user gives, or says where to find; empty where no reflectance is wanted.
std::vector<PointLight> lights_of(const RunOptions& options) {
    std::vector<PointLight> lights;
    if (!options.lights.empty()) {
        for (const sensor::PointLight& light : sensor::read_lights(options.lights))
            lights.push_back({glm::vec3(light.position_m), glm::vec3(light.intensity), 0});
    } else if (!options.lighting.empty()) {
        LightsOptions find;
        find.sequence = options.lighting;
        find.quiet = options.quiet;
        find.device = options.device;
        for (const FoundLight& light : find_lights(find))
            lights.push_back({light.position_m, light.intensity, light.radius_m});
        if (lights.empty()) throw Error("no lamp was found in the lighting sequence '", options.lighting, "'");
    }
    return lights;
}

/// With lights, reflectance is estimated; without, there is nothing to estimate it from.
ReconstructionSettings settings_of(const RunOptions& options, const sensor::SequenceInfo& info,
                                   const std::vector<PointLight>& lights) {
    ReconstructionSettings settings = options.settings;
    const bool drifts = options.gains == GainMode::kAuto && !info.exposure_known && settings.fusion.color;
    if (options.gains == GainMode::kOff) settings.gains.reset();
    if ((drifts || options.gains == GainMode::kOn) && !settings.gains) settings.gains.emplace();
    if (lights.empty()) {
        const bool asked = options.truth_labels || options.truth_materials || settings.reflectance;
        if (asked) throw Error("reflectance needs lights: give --lights FILE or --lighting SEQUENCE");
    } else if (!settings.reflectance) {
        settings.reflectance.emplace();
    }
    return settings;
}

PassTime summarised(const graph::Timing& timing) {
    std::vector<float> sorted = timing.samples_ms;
    std::sort(sorted.begin(), sorted.end());
    return {timing.name, sorted.size(), sorted.front(), sorted[sorted.size() / 2], sorted.back()};
}

/// Told before the work starts, although the graph is written at its end.
void check_graph_folder(const std::filesystem::path& dump_graph) {
    const std::filesystem::path parent = dump_graph.parent_path();
    if (!parent.empty() && !std::filesystem::is_directory(parent)) {
        throw Error("the graph cannot be written to '", dump_graph.string(), "': there is no folder '", parent.string(),
                    "'");
    }
}

void write_text(const std::filesystem::path& path, const std::string& content) {
    std::ofstream out(path, std::ios::binary);
    out << content;
    if (!out.flush()) throw Error("the file '", path.string(), "' cannot be written");
}

/// One run from source to folder.
class Run {
  public:
    Run(const RunOptions& options, const InterruptGuard& interrupt, OutputFolder& folder, vulkan::Device& device,
        sensor::Source& source, std::vector<PointLight> lights, const RunTruth& truth)
        : options_(options),
          interrupt_(interrupt),
          folder_(folder),
          device_(device),
          source_(source),
          info_(source.info()),
          lights_(std::move(lights)),
          truth_(truth),
          settings_(settings_of(options, info_, lights_)),
          reconstruction_(device, settings_),
          held_out_(options.hold_out) {
        if (reconstruction_.reflectance()) prepare_reflectance(*reconstruction_.reflectance());
        if (options.frames > 0) info_.frames = std::min(info_.frames, options.frames);
        dumps_.emplace(folder, info_.frames, options.dump_every);
    }

    void fuse_all() {
        Progress progress(info_.frames, options_.quiet);
        for (uint32_t done = 0; done < info_.frames; ++done) {
            stop_if_interrupted();
            const auto reading = source_.next();
            if (!reading) break;
            ledger_.note(*reading);
            if (const auto* skipped = std::get_if<sensor::Skipped>(&*reading)) {
                progress.say("frame " + std::to_string(skipped->index) + " is skipped: " + skipped->reason);
            } else {
                fuse(std::get<sensor::Frame>(*reading));
            }
            warn_when_full(progress);
            progress.update(done + 1, fmt::format("{} blocks", blocks_used()));
        }
        reconstruction_.wait();
        dumps_->finish();
        if (const auto discrepancy = ledger_.discrepancy(info_)) throw Error(*discrepancy);
        if (ledger_.used() == 0) {
            throw Error("no frame of '", options_.sequence,
                        "' could be used; the first was skipped because: ", ledger_.skipped().front().reason);
        }
        times_s_.emplace_back("frames", seconds_since(start_));
    }

    void write_results() {
        const auto start = Clock::now();
        const Mesh mesh = reconstruction_.extract_surface();
        times_s_.emplace_back("surface", seconds_since(start));
        check_validation();
        stop_if_interrupted();
        const GlbSummary scene = write_glb(folder_.stage("scene.glb"), mesh, {.version = kVersion, .name = info_.name});
        folder_.publish("scene.glb");
        folder_.write("trajectory.txt", trajectory_text(poses_));
        if (settings_.gains) folder_.write("gains.txt", gains_text());
        if (options_.hold_out > 0) compare_held_out();
        if (!lights_.empty()) write_lights();
        if (!options_.dump_graph.empty()) {
            write_text(options_.dump_graph.string() + ".dot", graph_dot_);
            write_text(options_.dump_graph.string() + ".json", graph_json_);
        }
        times_s_.emplace_back("total", seconds_since(start_));
        const RunRecord record = make_record(scene);
        folder_.write("report.html", report_html(record, dumps_->previews()));
        stop_if_interrupted();
        folder_.write("run.json", run_json(record));
        if (!options_.quiet) {
            fmt::print("{} of {} frames, {} triangles in {}\n", ledger_.used(), info_.frames, scene.triangles,
                       folder_.path().string());
            for (const std::string& warning : record.warnings) fmt::print("warning: {}\n", warning);
        }
    }

  private:
    void prepare_reflectance(ReflectanceModel& reflectance) {
        reflectance.set_lights(lights_);
        if (!options_.truth_materials) return;
        for (const sensor::Material& m : truth_.materials())
            reflectance.set_material(m.id, glm::vec3(m.ks), static_cast<float>(m.alpha));
    }

    void fuse(const sensor::Frame& frame) {
        if (!frame.world_from_camera) {
            ledger_.skip(frame.index, fmt::format("frame {} has no pose", frame.index));
            return;
        }
        RgbdFrame rgbd = to_rgbd(info_, frame);
        Image<uint16_t> labels;
        if (options_.truth_labels) {
            labels = truth_.labels(frame.index, info_.depth.extent);
            rgbd.labels = labels.pixels();
        }
        rgbd.shutter_share = shutter_share(frame);
        rgbd.held_out = held_out_.wants(frame.index);
        if (rgbd.held_out) held_out_.keep(frame, reconstruction_.frames());
        reconstruction_.add(rgbd);
        ledger_.use(frame.index);
        used_.push_back(frame.index);
        poses_.push_back({frame.timestamp_s, *frame.world_from_camera});
        if (!options_.dump_graph.empty()) {
            const graph::CompiledFrame& compiled = reconstruction_.runner().last_frame();
            graph_dot_ = graph::to_dot(compiled.description, compiled.plan);
            graph_json_ = graph::to_json(compiled.description, compiled.plan);
        }
        dumps_->after(reconstruction_, info_, frame);
        if (ledger_.used() == 1) {
            reconstruction_.wait();
            times_s_.emplace_back("first_fused_frame", seconds_since(start_));
        }
    }

    /// Of the time since the frame before, in which the shutter was open. Where nobody knows, half a frame's time.
    float shutter_share(const sensor::Frame& frame) const {
        if (info_.rendered || poses_.empty()) return 0;
        const double open_s = info_.exposure_known ? frame.exposure.exposure_s : 0.5 / info_.fps;
        const double since_s = std::max(frame.timestamp_s - poses_.back().timestamp_s, 0.5 / info_.fps);
        return static_cast<float>(std::min(open_s / since_s, 1.0));
    }

    std::string gains_text() {
        std::string lines = "# index, then the gains of red, green and blue over the first frame's\n";
        const auto gains = reconstruction_.gains();
        for (size_t i = 0; i < gains.size(); ++i) {
            const glm::vec4 gain = gains[i].gain;
            lines += fmt::format("{} {:.4f} {:.4f} {:.4f}\n", used_[i], gain.r, gain.g, gain.b);
        }
        return lines;
    }

    void compare_held_out() {
        const auto start = Clock::now();
        reconstruction_.refine_all();
        held_out_record_ = held_out_.compare(reconstruction_, info_, folder_);
        times_s_.emplace_back("held_out", seconds_since(start));
    }

    void stop_if_interrupted() {
        if (!interrupt_.requested()) return;
        reconstruction_.wait();
        dumps_->finish();
        throw Interrupted("interrupted after ", ledger_.read(), " of ", info_.frames, " frames; '",
                          folder_.path().string(), "' holds what was complete, and no run.json");
    }

    void write_lights() {
        std::vector<sensor::PointLight> lights;
        for (const PointLight& light : lights_)
            lights.push_back({glm::dvec3(light.position_m), glm::dvec3(light.intensity), light.radius_m});
        sensor::write_lights(folder_.stage("lights.json"), lights);
        folder_.publish("lights.json");
    }

    void check_validation() const {
        if (const auto messages = device_.validation_messages(); !messages.empty()) {
            throw Error("the validation layer reported ", messages.size(), " messages, the first: ", messages.front());
        }
    }

    uint32_t blocks_used() { return options_.settings.map.capacity_blocks - reconstruction_.counters().free_blocks; }

    void warn_when_full(Progress& progress) {
        if (warned_full_ || reconstruction_.counters().refused_blocks == 0) return;
        warned_full_ = true;
        progress.say(fmt::format("warning: the voxel pool of {} blocks is full; new surface is left out from here on",
                                 options_.settings.map.capacity_blocks));
    }

    RunRecord make_record(const GlbSummary& scene) {
        RunRecord record;
        record.version = kVersion;
        const vulkan::DeviceCaps& caps = device_.caps();
        record.device = {caps.name, vulkan::name_of(caps.type), caps.api_version, caps.driver};
        record.seed = options_.seed;
        record.settings = settings_json(settings_);
        record.settings["lights"] = lights_.size();
        record.settings["truth_labels"] = options_.truth_labels;
        record.settings["truth_materials"] = options_.truth_materials;
        record.settings["sequence"] = options_.sequence;
        record.settings["frames"] = options_.frames;
        record.settings["hold_out"] = options_.hold_out;
        record.settings["dump_every"] = options_.dump_every;
        record.sequence = info_;
        record.frames = {ledger_.read(), ledger_.used(), ledger_.skipped()};
        const gpu::MapCounters& counters = reconstruction_.counters();
        const uint64_t capacity = options_.settings.map.capacity_blocks;
        record.voxel_pool = {blocks_used(), capacity, counters.refused_blocks};
        for (const auto& pool : reconstruction_.map().memory()) {
            record.memory.push_back({pool.name, pool.bytes, blocks_used(), capacity});
        }
        if (ReflectanceModel* reflectance = reconstruction_.reflectance()) {
            for (const auto& pool : reflectance->memory()) record.memory.push_back({pool.name, pool.bytes, 0, 0});
        }
        record.memory.push_back({"transient resources", reconstruction_.runner().transient_bytes(), 0, 0});
        record.totals = {{"vertices", scene.vertices},
                         {"triangles", scene.triangles},
                         {"degenerate triangles left out", scene.degenerate_triangles},
                         {"blocks removed without surface", counters.deleted_blocks}};
        record.color_gains = gain_ranges();
        record.held_out = held_out_record_;
        record.warnings = warnings(counters);
        for (const graph::Timing& timing : reconstruction_.runner().pass_timings()) {
            if (!timing.samples_ms.empty()) record.passes.push_back(summarised(timing));
        }
        record.passes.push_back(summarised(reconstruction_.runner().host_timing()));
        record.times_s = times_s_;
        return record;
    }

    /// Per channel; empty where no gains were estimated.
    std::vector<ValueRange> gain_ranges() {
        std::vector<ValueRange> ranges;
        if (reconstruction_.gains().empty()) return ranges;
        for (glm::length_t channel = 0; channel < 3; ++channel) {
            std::vector<float> sorted;
            for (const gpu::ColorGains& gains : reconstruction_.gains()) sorted.push_back(gains.gain[channel]);
            std::sort(sorted.begin(), sorted.end());
            ranges.push_back({sorted.front(), sorted[sorted.size() / 2], sorted.back()});
        }
        return ranges;
    }

    std::vector<std::string> warnings(const gpu::MapCounters& counters) const {
        std::vector<std::string> list;
        if (counters.refused_blocks > 0) {
            list.push_back(
                fmt::format("the voxel pool was full: {} requests for a block were refused, its capacity is {}; raise "
                            "map.capacity_blocks, or map.voxel_m",
                            counters.refused_blocks, options_.settings.map.capacity_blocks));
        }
        if (counters.refused_samples > 0) {
            list.push_back(
                fmt::format("the voxel table was full: {} ray samples were left out", counters.refused_samples));
        }
        if (counters.outside_samples > 0) {
            list.push_back(
                fmt::format("{} ray samples lay outside the volume that block keys can express around the first camera",
                            counters.outside_samples));
        }
        return list;
    }

    const RunOptions& options_;
    const InterruptGuard& interrupt_;
    OutputFolder& folder_;
    vulkan::Device& device_;
    sensor::Source& source_;
    sensor::SequenceInfo info_;
    Clock::time_point start_ = Clock::now();
    std::vector<PointLight> lights_;
    const RunTruth& truth_;
    ReconstructionSettings settings_;
    Reconstruction reconstruction_;
    sensor::Ledger ledger_;
    std::optional<FrameDumps> dumps_;
    HeldOut held_out_;
    std::optional<HeldOutRecord> held_out_record_;
    std::vector<TimedPose> poses_;
    std::vector<uint32_t> used_;  ///< indices of the frames that were fused
    std::vector<std::pair<std::string, double>> times_s_;
    std::string graph_dot_, graph_json_;
    bool warned_full_ = false;
};

}  // namespace

void run(const RunOptions& options) {
    const InterruptGuard interrupt;  // from the first file to the last, so that none is left half-written
    OutputFolder folder(options.out);
    check_graph_folder(options.dump_graph);
    std::optional<vulkan::Device> device;  // outlives the source, which may compute on it
    std::unique_ptr<sensor::Source> recorded;
    std::unique_ptr<sensor::SyntheticSource> rendered;
    if (!is_synthetic(options)) recorded = open_recording(options);
    std::vector<PointLight> lights = lights_of(options);
    device.emplace(options.device);
    if (is_synthetic(options)) rendered = open_synthetic(options, *device);
    const RunTruth truth(options.sequence, rendered.get());
    sensor::Source& source = recorded ? *recorded : *rendered;
    Run job(options, interrupt, folder, *device, source, std::move(lights), truth);
    job.fuse_all();
    job.write_results();
}

}  // namespace patina::tools
