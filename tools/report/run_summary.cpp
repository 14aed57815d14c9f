#include "tools/report/run_summary.h"

#include "engine/core/digest.h"
#include "sensor/camera_json.h"

namespace patina {
namespace {

using Json = nlohmann::ordered_json;

Json sequence_json(const SequenceInfo& sequence) {
    return {{"name", sequence.name},
            {"format", sequence.format},
            {"fps", sequence.fps},
            {"frames", sequence.frames.value_or(0)},
            {"color", sensor::camera_json(sequence.color)},
            {"depth", sensor::camera_json(sequence.depth)},
            {"max_metres", sequence.max_metres},
            {"has_poses", sequence.has_poses}};
}

Json frames_json(const FrameLedger& frames) {
    Json skipped = Json::array();
    for (const Skipped& frame : frames.skipped) skipped.push_back({{"index", frame.index}, {"reason", frame.reason}});
    Json json{{"read", frames.read}, {"used", frames.used}};
    if (frames.dropped > 0) json["dropped"] = frames.dropped;
    if (frames.repeated > 0) json["repeated"] = frames.repeated;
    if (frames.undone > 0) json["undone"] = frames.undone;
    json["skipped"] = std::move(skipped);
    return json;
}

Json memory_json(const std::vector<MemorySummary>& pools) {
    Json result = Json::object();
    for (const MemorySummary& pool : pools) {
        result[pool.name] = {{"bytes", pool.bytes}, {"used", pool.used}, {"capacity", pool.capacity}};
    }
    return result;
}

Json passes_json(const std::vector<PassTime>& passes) {
    Json result = Json::object();
    for (const PassTime& pass : passes) {
        result[pass.name] = {
            {"count", pass.count}, {"min_ms", pass.min_ms}, {"median_ms", pass.median_ms}, {"max_ms", pass.max_ms}};
    }
    return result;
}

Json gains_json(const std::vector<ValueRange>& gains) {
    Json result = Json::object();
    constexpr const char* kChannels[] = {"red", "green", "blue"};
    for (size_t i = 0; i < gains.size(); ++i)
        result[kChannels[i]] = {{"min", gains[i].min}, {"median", gains[i].median}, {"max", gains[i].max}};
    return result;
}

Json score_json(const PictureScore& score) {
    return {
        {"coverage", score.coverage}, {"psnr_linear_db", score.psnr_linear_db}, {"psnr_srgb_db", score.psnr_srgb_db}};
}

Json held_out_json(const HeldOutSummary& held_out) {
    return {
        {"pictures", held_out.pictures},
        {"mean_color", score_json(held_out.mean_color)},
        {"reflectance", held_out.reflectance ? score_json(*held_out.reflectance) : Json()},
        {"mean_color_own_gain", score_json(held_out.mean_color_own_gain)},
        {"reflectance_own_gain", held_out.reflectance_own_gain ? score_json(*held_out.reflectance_own_gain) : Json()},
        {"records", held_out.records ? score_json(*held_out.records) : Json()}};
}

template <class Value>
Json object_of(const std::vector<std::pair<std::string, Value>>& pairs, const char* suffix = "") {
    Json result = Json::object();
    for (const auto& [key, value] : pairs) result[key + suffix] = value;
    return result;
}

std::string dumped(const Json& json) { return json.dump(2, ' ', false, Json::error_handler_t::replace); }

Json json_of(const RunSummary& summary) {
    Json run;
    run["format"] = "patina-run";
    run["version"] = summary.version;
    run["id"] = summary.id;
    run["finished"] = summary.finished;
    if (!summary.finished) run["ended"] = summary.ended;
    run["device"] = {
        {"name", summary.device.name}, {"type", summary.device.type}, {"vulkan", summary.device.vulkan_version}};
    run["driver"] = summary.device.driver;
    run["seed"] = summary.seed;
    run["settings"] = summary.settings;
    if (!summary.detail.empty()) run["detail"] = summary.detail;
    run["lights"] = summary.lights;
    run["sequence"] = sequence_json(summary.sequence);
    run["frames"] = frames_json(summary.frames);
    run["voxel_pool"] = {{"blocks_used", summary.voxel_pool.blocks_used},
                         {"blocks_capacity", summary.voxel_pool.blocks_capacity},
                         {"blocks_refused", summary.voxel_pool.blocks_refused}};
    if (const auto& pool = summary.observation_pool) {
        run["observation_pool"] = {{"records_used", pool->records_used},
                                   {"records_capacity", pool->records_capacity},
                                   {"records_refused", pool->records_refused},
                                   {"blocks_refused", pool->blocks_refused}};
    }
    run["memory"] = memory_json(summary.memory);
    run["totals"] = object_of(summary.totals);
    if (summary.live) run["live"] = live_json(*summary.live);
    if (!summary.tracking.empty()) run["tracking"] = tracking_json(summary.tracking);
    if (!summary.color_gains.empty()) run["color_gains"] = gains_json(summary.color_gains);
    if (summary.held_out) run["held_out"] = held_out_json(*summary.held_out);
    if (summary.world_offset_m != glm::dvec3(0))
        run["world_offset_m"] = {summary.world_offset_m.x, summary.world_offset_m.y, summary.world_offset_m.z};
    if (!summary.gltf.empty()) run["gltf"] = summary.gltf;
    if (!summary.materials_missing.empty()) run["materials_missing"] = summary.materials_missing;
    run["shortfalls"] = summary.shortfalls;
    run["warnings"] = summary.warnings;
    run["passes"] = passes_json(summary.passes);
    run["times"] = object_of(summary.times_s, "_s");
    run["files"] = summary.files;
    return run;
}

}  // namespace

std::string run_json(const RunSummary& summary) { return dumped(json_of(summary)) + '\n'; }

std::string run_id(const RunSummary& summary, uint64_t files_digest) {
    Json what = json_of(summary);
    // The memory of transient resources depends on what ran before: less did after a break.
    for (const char* key : {"id", "passes", "times", "memory", "live"}) what.erase(key);
    Digest digest;
    digest.add(dumped(what));
    digest.add(std::to_string(files_digest));
    return digest.digits();
}

}  // namespace patina
