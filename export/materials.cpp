#include "export/materials.h"

#include <cmath>
#include <string>

#include <nlohmann/json.hpp>

#include "export/gltf_material.h"

namespace patina {
namespace {

using Json = nlohmann::ordered_json;

/// To four decimals: more than the estimate is worth, and short to read.
double rounded(float value) { return std::round(double{value} * 1e4) / 1e4; }
Json rounded(glm::vec3 v) { return Json::array({rounded(v.r), rounded(v.g), rounded(v.b)}); }

/// By channel, [least, most].
Json channels(glm::vec3 low, glm::vec3 high) {
    Json list = Json::array();
    for (glm::length_t c = 0; c < 3; ++c) list.push_back({rounded(low[c]), rounded(high[c])});
    return list;
}

Json interval_json(const MaterialInterval& interval, bool kd_is_known) {
    Json json = Json::object();
    if (kd_is_known) json["kd"] = channels(interval.kd_low, interval.kd_high);
    json["ks"] = channels(interval.ks_low, interval.ks_high);
    json["alpha"] = {rounded(interval.alpha_low), rounded(interval.alpha_high)};
    return json;
}

/// A guess is told apart from what was observed.
void add_gloss(const SegmentReflectance& segment, Json& entry) {
    const bool observed = segment.gloss && is_observed(*segment.gloss);
    if (!observed) entry["gloss"] = "not observed";
    if (!segment.gloss) return;
    Json& values = observed ? entry : entry["guess"];
    values["ks"] = rounded(segment.gloss->ks);
    values["alpha"] = rounded(segment.gloss->alpha);
    if (segment.gloss->confidence) entry["specular_confidence"] = rounded(*segment.gloss->confidence);
}

/// "interval" is that of 90 %; the others have their percentage in their name.
void add_intervals(const SegmentReflectance& segment, Json& entry) {
    if (!segment.intervals) return;
    const auto& intervals = *segment.intervals;
    entry["interval"] = interval_json(intervals[kIntervalLevel], segment.kd.has_value());
    for (size_t i = 0; i < intervals.size(); ++i) {
        if (i == kIntervalLevel) continue;
        const std::string percent = std::to_string(std::lround(100 * kIntervalLevels[i]));
        entry["interval_" + percent] = interval_json(intervals[i], segment.kd.has_value());
    }
}

}  // namespace

std::string materials_json(std::span<const SegmentReflectance> segments, std::span<const std::string> names) {
    Json list = Json::array();
    for (size_t label = 1; label < segments.size(); ++label) {
        const SegmentReflectance& segment = segments[label];
        if (segment.voxels == 0) continue;
        Json entry{{"id", label}};
        if (label < names.size() && !names[label].empty()) entry["name"] = names[label];
        if (segment.kd) entry["kd"] = rounded(*segment.kd);
        add_gloss(segment, entry);
        entry["voxels"] = segment.voxels;
        entry["observations"] = segment.observations;
        entry["confidence"] = rounded(segment.confidence);
        add_intervals(segment, entry);
        list.push_back(std::move(entry));
    }
    return Json{{"materials", std::move(list)}}.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace patina
