#include "tools/run/make_record.h"

#include <algorithm>
#include <string_view>

#include <fmt/format.h>

#include "engine/core/version.h"
#include "reconstruction/api/statistics.h"
#include "reconstruction/session/choices.h"
#include "reconstruction/session/session_lights.h"
#include "reconstruction/session/session_materials.h"
#include "reconstruction/session/shortfalls.h"
#include "reconstruction/setting_table.h"

namespace patina::tools {

namespace {

nlohmann::ordered_json settings_of(const RunOptions& options, const ReconstructionSettings& settings) {
    nlohmann::ordered_json json = settings_json(settings);
    json["lighting"] = name_of(options.lighting);
    json["labels"] = name_of(options.labels);
    json["specular"] = specular_mode(settings);
    json["truth_materials"] = options.materials == Materials::kTruth;
    json["sequence"] = options.sequence;
    json["frames"] = options.frames;
    json["hold_out"] = options.hold_out;
    json["dump_every"] = options.dump_every;
    return json;
}

/// Per channel; empty where no gains were estimated.
std::vector<ValueRange> gain_ranges(Pipeline& reconstruction) {
    std::vector<ValueRange> ranges;
    if (reconstruction.gains().empty()) return ranges;
    for (glm::length_t channel = 0; channel < 3; ++channel) {
        std::vector<float> sorted;
        for (const gpu::ColorGains& gains : reconstruction.gains()) sorted.push_back(gains.gain[channel]);
        std::sort(sorted.begin(), sorted.end());
        ranges.push_back({sorted.front(), sorted[sorted.size() / 2], sorted.back()});
    }
    return ranges;
}

void add_pools(RunRecord& record, SessionCore& fusion) {
    Pipeline& reconstruction = fusion.reconstruction();
    const std::vector<PoolState> pools = fusion.pools();
    const auto state_of = [&](std::string_view name) -> const PoolState* {
        const auto found = std::find_if(pools.begin(), pools.end(), [&](const auto& p) { return p.name == name; });
        return found == pools.end() ? nullptr : &*found;
    };
    const PoolState& blocks = *state_of("voxel blocks");
    record.voxel_pool = {blocks.used, blocks.capacity, blocks.refused};
    if (const PoolState* records = state_of("observed voxels")) {
        record.observation_pool = {records->used, records->capacity, records->refused,
                                   state_of("observed blocks")->refused};
    }
    for (const auto& pool : reconstruction.map().memory()) {
        record.memory.push_back({pool.name, pool.bytes, blocks.used, blocks.capacity});
    }
    const auto add = [&](const auto* model) {
        if (!model) return;
        for (const auto& pool : model->memory()) record.memory.push_back({pool.name, pool.bytes, 0, 0});
    };
    add(reconstruction.segmentation());
    add(reconstruction.reflectance());
    add(reconstruction.specular());
    add(reconstruction.tracking());
    if (const KeyframeStage* model = reconstruction.keyframes())
        record.memory.push_back({"keyframes", model->store().bytes(), 0, 0});
    record.memory.push_back({"transient resources", reconstruction.runner().transient_bytes(), 0, 0});
}

void add_segment_totals(RunRecord& record, const Statistics& statistics) {
    const gpu::SegmentCounters& segments = statistics.segments;
    const LabelStability& stability = statistics.label_stability;
    record.totals.emplace_back("segments", segments.live);
    record.totals.emplace_back("labels made", segments.created);
    record.totals.emplace_back("labels merged", segments.merged);
    record.totals.emplace_back("labels pruned", segments.pruned);
    record.totals.emplace_back("votes for labels of voxels after the first frames", stability.voxels);
    record.totals.emplace_back("of these, changes from one label to another", stability.flips);
    record.totals.emplace_back("voxels in sight in these frames, about", static_cast<uint64_t>(stability.seen));
}

void add_passes(RunRecord& record, const graph::Runner& runner) {
    for (const graph::Timing& timing : runner.pass_timings()) {
        if (!timing.samples_ms.empty()) record.passes.push_back(summarised(timing));
    }
    if (!runner.host_timing().samples_ms.empty()) record.passes.push_back(summarised(runner.host_timing()));
}

}  // namespace

RunRecord make_record(const RunOptions& options, SessionCore& fusion, const GlbSummary& scene) {
    Pipeline& reconstruction = fusion.reconstruction();
    RunRecord record;
    record.version = kVersion;
    const vulkan::DeviceCaps& caps = fusion.device().caps();
    record.device = {caps.name, vulkan::name_of(caps.type), caps.api_version, caps.driver};
    record.seed = fusion.settings().seed;
    record.settings = settings_of(options, fusion.settings());
    record.lights = lights_json(fusion.illumination());
    record.sequence = fusion.info();
    if (!record.sequence.frames) record.sequence.frames = fusion.ledger().read();
    record.frames = {fusion.ledger().read(), fusion.ledger().used(), fusion.ledger().skipped()};
    record.world_offset_m = fusion.world_offset_m();
    add_pools(record, fusion);
    const Statistics statistics = reconstruction.statistics();
    record.totals = {{"vertices", scene.vertices},
                     {"triangles", scene.triangles},
                     {"degenerate triangles left out", scene.degenerate_triangles},
                     {"blocks removed without surface", statistics.map.deleted_blocks}};
    if (reconstruction.segmentation()) add_segment_totals(record, statistics);
    record.tracking = fusion.tracked();
    record.color_gains = gain_ranges(reconstruction);
    record.materials_missing = fusion.materials_missing();
    record.warnings = warnings(fusion);
    add_passes(record, reconstruction.runner());
    return record;
}

void add_keyframes(RunRecord& record, SessionCore& fusion) {
    if (!fusion.reconstruction().keyframes()) return;
    const gpu::KeyframeCounters keyframes = fusion.reconstruction().keyframe_counters();
    record.totals.emplace_back("keyframes", keyframes.used);
    if (keyframes.refused > 0) {
        record.warnings.push_back(
            fmt::format("the store of keyframes was full: {} were refused, its capacity is {}; raise "
                        "keyframes.capacity",
                        keyframes.refused, fusion.settings().keyframes->store.capacity));
    }
}

}  // namespace patina::tools
