#include "export/materials.h"

#include <cmath>

#include <nlohmann/json.hpp>

namespace patina {
namespace {

using Json = nlohmann::ordered_json;

/// To four decimals: more than the estimate is worth, and short to read.
double rounded(float value) { return std::round(double{value} * 1e4) / 1e4; }
Json rounded(glm::vec3 v) { return Json::array({rounded(v.r), rounded(v.g), rounded(v.b)}); }

}  // namespace

std::string materials_json(std::span<const SegmentReflectance> segments, std::span<const std::string> names) {
    Json list = Json::array();
    for (size_t label = 1; label < segments.size(); ++label) {
        const SegmentReflectance& segment = segments[label];
        if (segment.voxels == 0) continue;
        Json entry{{"id", label}};
        if (label < names.size() && !names[label].empty()) entry["name"] = names[label];
        if (segment.kd) entry["kd"] = rounded(*segment.kd);
        if (segment.gloss) {
            entry["ks"] = rounded(segment.gloss->ks);
            entry["alpha"] = rounded(segment.gloss->alpha);
            if (segment.gloss->confidence) entry["specular_confidence"] = rounded(*segment.gloss->confidence);
        }
        entry["voxels"] = segment.voxels;
        entry["observations"] = segment.observations;
        entry["confidence"] = rounded(segment.confidence);
        list.push_back(std::move(entry));
    }
    return Json{{"materials", std::move(list)}}.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace patina
