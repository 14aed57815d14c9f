#include "tools/run/summarise_run.h"

#include <algorithm>
#include <string_view>

#include <fmt/format.h>

#include "engine/core/version.h"
#include "reconstruction/api/statistics.h"
#include "reconstruction/session/choices.h"
#include "reconstruction/session/session_lights.h"
#include "reconstruction/session/session_materials.h"
#include "reconstruction/session/session_state.h"
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
std::vector<ValueRange> gain_ranges(Pipeline& pipeline) {
    std::vector<ValueRange> ranges;
    if (pipeline.gains().empty()) return ranges;
    for (glm::length_t channel = 0; channel < 3; ++channel) {
        std::vector<float> sorted;
        for (const gpu::ColorGains& gains : pipeline.gains()) sorted.push_back(gains.gain[channel]);
        std::sort(sorted.begin(), sorted.end());
        ranges.push_back({sorted.front(), sorted[sorted.size() / 2], sorted.back()});
    }
    return ranges;
}

void add_pools(RunSummary& summary, SessionCore& session) {
    Pipeline& pipeline = session.pipeline();
    const std::vector<PoolState> pools = session.pools();
    const auto state_of = [&](std::string_view name) -> const PoolState* {
        const auto found = std::find_if(pools.begin(), pools.end(), [&](const auto& p) { return p.name == name; });
        return found == pools.end() ? nullptr : &*found;
    };
    const PoolState& blocks = *state_of("voxel blocks");
    summary.voxel_pool = {blocks.used, blocks.capacity, blocks.refused};
    if (const PoolState* records = state_of("observed voxels")) {
        summary.observation_pool = {records->used, records->capacity, records->refused,
                                    state_of("observed blocks")->refused};
    }
    for (const auto& pool : pipeline.map().memory()) {
        summary.memory.push_back({pool.name, pool.bytes, blocks.used, blocks.capacity});
    }
    const auto add = [&](const auto* stage) {
        if (!stage) return;
        for (const auto& pool : stage->memory()) summary.memory.push_back({pool.name, pool.bytes, 0, 0});
    };
    add(pipeline.segmentation());
    add(pipeline.reflectance());
    add(pipeline.specular());
    add(pipeline.tracking());
    if (const KeyframeStage* keyframes = pipeline.keyframes())
        summary.memory.push_back({"keyframes", keyframes->store().bytes(), 0, 0});
    summary.memory.push_back({"transient resources", pipeline.runner().transient_bytes(), 0, 0});
}

void add_stream_totals(RunSummary& summary, Pipeline& pipeline) {
    const StreamCounts blocks = pipeline.streamed_blocks(), records = pipeline.streamed_records();
    if (blocks.left > 0) {
        summary.totals.emplace_back("blocks that left the device", blocks.left);
        summary.totals.emplace_back("blocks that came back", blocks.returned);
        summary.totals.emplace_back("blocks that a frame waited for", blocks.awaited);
    }
    if (blocks.filed > 0) summary.totals.emplace_back("blocks that went to the temporary file", blocks.filed);
    if (records.left > 0) {
        summary.totals.emplace_back("observed voxels that left the device", records.left);
        summary.totals.emplace_back("blocks of them that came back", records.returned);
        summary.totals.emplace_back("blocks of them that a frame waited for", records.awaited);
    }
    if (records.filed > 0) summary.totals.emplace_back("blocks of them that went to the temporary file", records.filed);
}

void add_segment_totals(RunSummary& summary, const PipelineCounters& counters) {
    const gpu::SegmentCounters& segments = counters.segments;
    const LabelStability& stability = counters.label_stability;
    summary.totals.emplace_back("segments", segments.live);
    summary.totals.emplace_back("labels made", segments.created);
    summary.totals.emplace_back("labels split", segments.split);
    summary.totals.emplace_back("labels merged", segments.merged);
    summary.totals.emplace_back("labels pruned", segments.pruned);
    summary.totals.emplace_back("votes for labels of voxels after the first frames", stability.voxels);
    summary.totals.emplace_back("of these, changes from one label to another", stability.flips);
    summary.totals.emplace_back("voxels in sight in these frames, about", static_cast<uint64_t>(stability.seen));
}

void add_passes(RunSummary& summary, const graph::Runner& runner) {
    for (const graph::Timing& timing : runner.pass_timings()) {
        if (!timing.samples_ms.empty()) summary.passes.push_back(summarised(timing));
    }
    if (!runner.host_timing().samples_ms.empty()) summary.passes.push_back(summarised(runner.host_timing()));
}

}  // namespace

RunSummary summarise(const RunOptions& options, SessionCore& session, const GlbSummary& scene) {
    Pipeline& pipeline = session.pipeline();
    RunSummary summary;
    summary.version = kVersion;
    const vulkan::DeviceCaps& caps = session.device().caps();
    summary.device = {caps.name, vulkan::name_of(caps.type), caps.api_version, caps.driver};
    summary.seed = session.settings().seed;
    summary.settings = settings_of(options, session.settings());
    summary.detail = detail_json(session.detail());
    summary.lights = lights_json(session.illumination());
    summary.sequence = session.info();
    if (!summary.sequence.frames) summary.sequence.frames = session.ledger().read();
    summary.frames = {session.ledger().read(),    session.ledger().used(),     session.ledger().skipped(),
                      session.ledger().dropped(), session.ledger().repeated(), session.ledger().undone()};
    summary.world_offset_m = session.world_offset_m();
    add_pools(summary, session);
    const PipelineCounters counters = pipeline.counters();
    summary.totals = {{"vertices", scene.vertices},
                      {"triangles", scene.triangles},
                      {"degenerate triangles left out", scene.degenerate_triangles},
                      {"triangles of stray parts left out", scene.loose_triangles},
                      {"triangles collapsed", scene.collapsed_triangles},
                      {"holes closed", scene.closed_holes},
                      {"vertices that no colour picture saw", scene.unseen_vertices},
                      {"vertices whose base colour was clamped", scene.clamped_colors},
                      {"pages of the texture", scene.texture_pages},
                      {"normal maps", scene.detail_pages},
                      {"texels that a picture showed", scene.seen_texels},
                      {"texels that no picture showed", scene.filled_texels},
                      {"texels whose base colour was clamped", scene.clamped_texels},
                      {"blocks removed without surface", counters.map.deleted_blocks}};
    add_stream_totals(summary, pipeline);
    if (pipeline.segmentation()) add_segment_totals(summary, counters);
    summary.tracking = session.tracked();
    summary.color_gains = gain_ranges(pipeline);
    summary.materials_missing = session.materials_missing();
    summary.warnings = warnings(session);
    add_passes(summary, pipeline.runner());
    return summary;
}

void add_keyframes(RunSummary& summary, SessionCore& session) {
    if (!session.pipeline().keyframes()) return;
    const gpu::KeyframeCounters keyframes = session.pipeline().keyframe_counters();
    summary.totals.emplace_back("keyframes", keyframes.used);
    if (keyframes.refused > 0) {
        summary.warnings.push_back(
            fmt::format("the store of keyframes was full: {} were refused, its capacity is {}; raise "
                        "keyframes.capacity",
                        keyframes.refused, session.settings().keyframes->store.capacity));
    }
}

}  // namespace patina::tools
