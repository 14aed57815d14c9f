#include "tools/bench/stages.h"

#include <utility>

namespace patina::bench {

namespace {

/// What the names of a stage's passes and resources begin with.
constexpr std::pair<std::string_view, Stage> kPrefixes[] = {
    {"input.", kGeometry},
    {"kinect2.", kGeometry},
    {"fusion.", kGeometry},
    {"map.", kGeometry},
    {"photometry.", kGeometry},
    {"observation", kObservation},
    {"segmentation.", kSegmentation},
    {"segments.", kSegmentation},
    {"specular.", kSpecular},
    {"segment_materials", kSpecular},
    {"reflectance.", kAlbedo},
    {"lights", kAlbedo},
};

constexpr std::string_view kTransfers[] = {"fill.", "copy.", "upload.", "read_back."};

}  // namespace

Stage stage_of(std::string_view pass) {
    for (const std::string_view transfer : kTransfers) {
        if (!pass.starts_with(transfer)) continue;
        pass.remove_prefix(transfer.size());
        break;
    }
    for (const auto& [prefix, stage] : kPrefixes) {
        if (pass.starts_with(prefix)) return stage;
    }
    return kOther;
}

}  // namespace patina::bench
