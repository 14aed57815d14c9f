#include "tools/export/run_record.h"

namespace patina {
namespace {

using Json = nlohmann::ordered_json;

Json camera_json(const Intrinsics& camera) {
    return {{"width", camera.extent.width},
            {"height", camera.extent.height},
            {"fx", camera.fx},
            {"fy", camera.fy},
            {"cx", camera.cx},
            {"cy", camera.cy},
            {"distortion", camera.distortion}};
}

Json sequence_json(const sensor::SequenceInfo& sequence) {
    return {{"name", sequence.name},
            {"format", sequence.format},
            {"fps", sequence.fps},
            {"frames", sequence.frames},
            {"color", camera_json(sequence.color)},
            {"depth", camera_json(sequence.depth)},
            {"max_metres", sequence.max_metres},
            {"has_poses", sequence.has_poses}};
}

Json frames_json(const FrameLedger& frames) {
    Json skipped = Json::array();
    for (const sensor::Skipped& frame : frames.skipped)
        skipped.push_back({{"index", frame.index}, {"reason", frame.reason}});
    return {{"read", frames.read}, {"used", frames.used}, {"skipped", std::move(skipped)}};
}

Json memory_json(const std::vector<MemoryRecord>& pools) {
    Json result = Json::object();
    for (const MemoryRecord& pool : pools) {
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

template <class Value>
Json object_of(const std::vector<std::pair<std::string, Value>>& pairs, const char* suffix = "") {
    Json result = Json::object();
    for (const auto& [key, value] : pairs) result[key + suffix] = value;
    return result;
}

}  // namespace

std::string run_json(const RunRecord& record) {
    Json run;
    run["format"] = "patina-run";
    run["version"] = record.version;
    run["device"] = {
        {"name", record.device.name}, {"type", record.device.type}, {"vulkan", record.device.vulkan_version}};
    run["driver"] = record.device.driver;
    run["seed"] = record.seed;
    run["settings"] = record.settings;
    run["lights"] = record.lights;
    run["sequence"] = sequence_json(record.sequence);
    run["frames"] = frames_json(record.frames);
    run["voxel_pool"] = {{"blocks_used", record.voxel_pool.blocks_used},
                         {"blocks_capacity", record.voxel_pool.blocks_capacity},
                         {"blocks_refused", record.voxel_pool.blocks_refused}};
    run["memory"] = memory_json(record.memory);
    run["totals"] = object_of(record.totals);
    run["warnings"] = record.warnings;
    run["passes"] = passes_json(record.passes);
    run["times"] = object_of(record.times_s, "_s");
    return run.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
}

}  // namespace patina
