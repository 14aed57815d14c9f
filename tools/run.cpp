#include "tools/run.h"

#include <algorithm>
#include <chrono>
#include <fstream>

#include <fmt/format.h>

#include "engine/graph/plan/plan.h"
#include "tools/export/report.h"
#include "tools/export/run_record.h"
#include "tools/frame_dumps.h"
#include "tools/run_lights.h"
#include "tools/run_settings.h"
#include "tools/run_specular.h"
#include "tools/scene_files.h"
#include "tools/version.h"

namespace patina::tools {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

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
    Run(const RunOptions& options, const InterruptGuard& interrupt, OutputFolder& folder)
        : options_(options),
          folder_(folder),
          fusion_(options, interrupt),
          reconstruction_(fusion_.reconstruction()),
          dumps_(folder, fusion_.info().frames, options.dump_every) {}

    void fuse_all() {
        try {
            fusion_.fuse_all([this](const sensor::Frame& frame) { after(frame); });
        } catch (const Interrupted&) {
            dumps_.finish();
            throw;
        }
        dumps_.finish();
        times_s_.emplace_back("frames", seconds_since(start_));
    }

    void write_results() {
        const auto start = Clock::now();
        const Mesh mesh = reconstruction_.extract_surface();
        times_s_.emplace_back("surface", seconds_since(start));
        check_validation();
        fusion_.stop_if_interrupted();
        const SceneFiles scene(reconstruction_.sample_reflectance(mesh), fusion_.lights(),
                               fusion_.illumination().ambient,
                               options_.labels == "truth" ? fusion_.truth().names() : std::vector<std::string>());
        const GlbSummary summary = scene.write(folder_, mesh, {.version = kVersion, .name = fusion_.info().name});
        folder_.write("trajectory.txt", trajectory_text(fusion_.poses()));
        if (fusion_.settings().gains) folder_.write("gains.txt", fusion_.gains_text());
        if (options_.hold_out > 0) compare_held_out();
        if (!options_.dump_graph.empty()) {
            write_text(options_.dump_graph.string() + ".dot", graph_dot_);
            write_text(options_.dump_graph.string() + ".json", graph_json_);
        }
        times_s_.emplace_back("total", seconds_since(start_));
        RunRecord record = make_record(summary);
        scene.tell(record);
        folder_.write("report.html", report_html(record, dumps_.previews()));
        fusion_.stop_if_interrupted();
        folder_.write("run.json", run_json(record));
        if (!options_.quiet) {
            fmt::print("{} of {} frames, {} triangles in {}\n", fusion_.ledger().used(), fusion_.info().frames,
                       summary.triangles, folder_.path().string());
            for (const std::string& warning : record.warnings) fmt::print("warning: {}\n", warning);
        }
    }

  private:
    void after(const sensor::Frame& frame) {
        if (!options_.dump_graph.empty()) {
            const graph::CompiledFrame& compiled = reconstruction_.runner().last_frame();
            graph_dot_ = graph::to_dot(compiled.description, compiled.plan);
            graph_json_ = graph::to_json(compiled.description, compiled.plan);
        }
        dumps_.after(reconstruction_, fusion_.info(), frame);
        if (fusion_.ledger().used() == 1) {
            reconstruction_.wait();
            times_s_.emplace_back("first_fused_frame", seconds_since(start_));
        }
    }

    void compare_held_out() {
        const auto start = Clock::now();
        reconstruction_.refine_all();
        held_out_ = fusion_.held_out().compare(reconstruction_, fusion_.info(), folder_);
        times_s_.emplace_back("held_out", seconds_since(start));
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

    void check_validation() {
        if (const auto messages = fusion_.device().validation_messages(); !messages.empty()) {
            throw Error("the validation layer reported ", messages.size(), " messages, the first: ", messages.front());
        }
    }

    RunRecord make_record(const GlbSummary& scene) {
        RunRecord record;
        record.version = kVersion;
        const vulkan::DeviceCaps& caps = fusion_.device().caps();
        record.device = {caps.name, vulkan::name_of(caps.type), caps.api_version, caps.driver};
        record.seed = options_.seed;
        record.settings = settings_json(fusion_.settings());
        record.settings["lighting"] = options_.lighting;
        record.lights = lights_json(fusion_.illumination());
        record.settings["labels"] = options_.labels;
        record.settings["specular"] = specular_mode(fusion_.settings());
        record.settings["truth_materials"] = options_.truth_materials;
        record.settings["sequence"] = options_.sequence;
        record.settings["frames"] = options_.frames;
        record.settings["hold_out"] = options_.hold_out;
        record.settings["dump_every"] = options_.dump_every;
        record.sequence = fusion_.info();
        record.frames = {fusion_.ledger().read(), fusion_.ledger().used(), fusion_.ledger().skipped()};
        const gpu::MapCounters& counters = reconstruction_.counters();
        const uint64_t capacity = options_.settings.map.capacity_blocks;
        record.voxel_pool = {fusion_.blocks_used(), capacity, counters.refused_blocks};
        const ObservationCounters& observed = reconstruction_.observation_counters();
        if (const auto& reflectance = fusion_.settings().reflectance) {
            record.observation_pool = {observed.records.high_water, reflectance->capacity_records,
                                       observed.records.refused_blocks, observed.blocks.refused_blocks};
        }
        for (const auto& pool : reconstruction_.map().memory()) {
            record.memory.push_back({pool.name, pool.bytes, fusion_.blocks_used(), capacity});
        }
        if (const SegmentationModel* segmentation = reconstruction_.segmentation()) {
            for (const auto& pool : segmentation->memory()) record.memory.push_back({pool.name, pool.bytes, 0, 0});
        }
        if (ReflectanceModel* reflectance = reconstruction_.reflectance()) {
            for (const auto& pool : reflectance->memory()) record.memory.push_back({pool.name, pool.bytes, 0, 0});
        }
        if (const SpecularModel* specular = reconstruction_.specular()) {
            for (const auto& pool : specular->memory()) record.memory.push_back({pool.name, pool.bytes, 0, 0});
        }
        if (const TrackingModel* tracking = reconstruction_.tracking()) {
            for (const auto& pool : tracking->memory()) record.memory.push_back({pool.name, pool.bytes, 0, 0});
        }
        if (const KeyframeModel* model = reconstruction_.keyframes())
            record.memory.push_back({"keyframes", model->store().bytes(), 0, 0});
        record.memory.push_back({"transient resources", reconstruction_.runner().transient_bytes(), 0, 0});
        record.totals = {{"vertices", scene.vertices},
                         {"triangles", scene.triangles},
                         {"degenerate triangles left out", scene.degenerate_triangles},
                         {"blocks removed without surface", counters.deleted_blocks}};
        if (reconstruction_.segmentation()) add_segment_totals(record);
        const gpu::KeyframeCounters keyframes = reconstruction_.keyframe_counters();
        if (reconstruction_.keyframes()) record.totals.emplace_back("keyframes", keyframes.used);
        record.tracking = fusion_.tracked();
        record.color_gains = gain_ranges();
        record.held_out = held_out_;
        record.warnings = warnings(counters);
        if (keyframes.refused > 0) {
            record.warnings.push_back(
                fmt::format("the store of keyframes was full: {} were refused, its capacity is {}; raise "
                            "keyframes.capacity",
                            keyframes.refused, fusion_.settings().keyframes->store.capacity));
        }
        for (const graph::Timing& timing : reconstruction_.runner().pass_timings()) {
            if (!timing.samples_ms.empty()) record.passes.push_back(summarised(timing));
        }
        record.passes.push_back(summarised(reconstruction_.runner().host_timing()));
        record.times_s = times_s_;
        return record;
    }

    void add_segment_totals(RunRecord& record) {
        const gpu::SegmentCounters& segments = reconstruction_.segment_counters();
        const LabelStability& stability = reconstruction_.label_stability();
        record.totals.emplace_back("segments", segments.live);
        record.totals.emplace_back("labels made", segments.created);
        record.totals.emplace_back("labels merged", segments.merged);
        record.totals.emplace_back("labels pruned", segments.pruned);
        record.totals.emplace_back("votes for labels of voxels after the first frames", stability.voxels);
        record.totals.emplace_back("of these, changes from one label to another", stability.flips);
        record.totals.emplace_back("voxels in sight in these frames, about", static_cast<uint64_t>(stability.seen));
    }

    std::vector<std::string> warnings(const gpu::MapCounters& counters) {
        std::vector<std::string> list;
        if (const auto warning = fusion_.reach_warning()) list.push_back(*warning);
        if (counters.refused_blocks > 0) {
            list.push_back(
                fmt::format("the voxel pool was full: {} requests for a block were refused, its capacity is {}; raise "
                            "map.capacity_blocks, or map.voxel_m",
                            counters.refused_blocks, options_.settings.map.capacity_blocks));
        }
        const ObservationCounters& observed = reconstruction_.observation_counters();
        if (const uint32_t refused = observed.records.refused_blocks; refused > 0) {
            list.push_back(
                fmt::format("the pool of observed voxels was full: {} were refused, its capacity is {}; raise "
                            "reflectance.capacity_records, or reflectance.voxel_m",
                            refused, fusion_.settings().reflectance->capacity_records));
        }
        if (const uint32_t refused = observed.blocks.refused_blocks; refused > 0) {
            list.push_back(
                fmt::format("the pool of observed blocks was full: {} were refused, its capacity is {}; raise "
                            "reflectance.capacity_blocks",
                            refused, fusion_.settings().reflectance->capacity_blocks));
        }
        if (const uint32_t refused = reconstruction_.segment_counters().refused; refused > 0) {
            list.push_back(fmt::format(
                "{} segments of frames found all labels in use; raise segmentation.capacity_labels", refused));
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
    OutputFolder& folder_;
    Clock::time_point start_ = Clock::now();
    SequenceFusion fusion_;
    Reconstruction& reconstruction_;
    FrameDumps dumps_;
    std::optional<HeldOutRecord> held_out_;
    std::vector<std::pair<std::string, double>> times_s_;
    std::string graph_dot_, graph_json_;
};

}  // namespace

void run(const RunOptions& options) {
    const InterruptGuard interrupt;  // from the first file to the last, so that none is left half-written
    OutputFolder folder(options.out);
    check_graph_folder(options.dump_graph);
    try {
        Run job(options, interrupt, folder);
        job.fuse_all();
        job.write_results();
    } catch (const Interrupted& interrupted) {
        throw Interrupted(interrupted.what(), "; '", folder.path().string(),
                          "' holds what was complete, and no run.json");
    }
}

}  // namespace patina::tools
