#include "tools/eval/intervals.h"

#include <algorithm>
#include <map>
#include <string>

#include "engine/core/input_file.h"
#include "sensor/files/json_file.h"
#include "sensor/truth.h"

namespace patina::eval {
namespace {

namespace fs = std::filesystem;
using sensor::JsonValue;

constexpr double kRounding = 0.5e-4;  // of four decimals
constexpr uint64_t kMostLabels = UINT32_MAX;

/// The keys of materials.json, in rising order of their probability.
const std::vector<std::pair<double, std::string>> kLevels = {
    {0.5, "interval_50"}, {0.8, "interval_80"}, {0.9, "interval"}, {0.95, "interval_95"}};

void add(double truth, const JsonValue& interval, IntervalHits& hits) {
    const std::vector<double> ends = interval.numbers(2);
    hits.within += truth >= ends[0] - kRounding && truth <= ends[1] + kRounding ? 1 : 0;
    hits.width += ends[1] - ends[0];
    ++hits.values;
}

IntervalHits hits_of(glm::dvec3 truth, const JsonValue& channels) {
    IntervalHits hits;
    const std::vector<JsonValue> intervals = channels.elements_of(3);
    for (size_t c = 0; c < 3; ++c) add(truth[static_cast<glm::length_t>(c)], intervals[c], hits);
    return hits;
}

IntervalCounts compare(double probability, const JsonValue& interval, const sensor::Material& truth) {
    IntervalCounts counts{probability, {}, {}, {}};
    const auto kd = interval.find("kd");
    if (kd && truth.kd) counts.kd = hits_of(*truth.kd, *kd);
    counts.ks = hits_of(truth.ks, interval.at("ks"));
    add(truth.alpha, interval.at("alpha"), counts.alpha);
    return counts;
}

std::optional<ObjectIntervals> compare(const JsonValue& segment, const sensor::Material& truth) {
    ObjectIntervals result;
    if (const auto confidence = segment.find("specular_confidence")) result.confidence = confidence->number();
    for (const auto& [probability, key] : kLevels) {
        if (const auto interval = segment.find(key)) result.levels.push_back(compare(probability, *interval, truth));
    }
    if (result.levels.empty()) return std::nullopt;
    return result;
}

std::map<uint32_t, JsonValue> segments_of(const fs::path& file) {
    std::map<uint32_t, JsonValue> segments;
    for (const JsonValue& segment : JsonValue::read(file).at("materials").elements())
        segments.emplace(static_cast<uint32_t>(segment.at("id").whole_number(kMostLabels)), segment);
    return segments;
}

void add(const IntervalHits& hits, IntervalHits& sum) {
    sum.within += hits.within;
    sum.values += hits.values;
    sum.width += hits.width;
}

}  // namespace

void compare_intervals(const fs::path& sequence, const fs::path& run, std::vector<ObjectResult>& objects) {
    const fs::path truth_file = sequence / "truth" / "materials.json", run_file = run / "materials.json";
    if (!path_exists(truth_file) || !path_exists(run_file)) return;
    const std::map<uint32_t, JsonValue> segments = segments_of(run_file);
    const std::vector<sensor::Material> materials = sensor::read_materials(truth_file);
    for (ObjectResult& object : objects) {
        const auto truth = std::ranges::find(materials, object.id, &sensor::Material::id);
        if (truth == materials.end() || !object.segmentation || object.segmentation->iou < kMatchedIou) continue;
        const auto segment = segments.find(object.segmentation->best_label.value_or(0));
        if (segment != segments.end()) object.intervals = compare(segment->second, *truth);
    }
}

std::vector<IntervalCounts> count_intervals(std::span<const ObjectResult> objects) {
    std::vector<IntervalCounts> sums;
    for (const auto& [probability, key] : kLevels) {
        IntervalCounts sum{probability, {}, {}, {}};
        for (const ObjectResult& object : objects) {
            if (!object.intervals) continue;
            for (const IntervalCounts& own : object.intervals->levels) {
                if (own.probability != probability) continue;
                add(own.kd, sum.kd);
                add(own.ks, sum.ks);
                add(own.alpha, sum.alpha);
            }
        }
        if (sum.alpha.values > 0) sums.push_back(sum);
    }
    return sums;
}

}  // namespace patina::eval
