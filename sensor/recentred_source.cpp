#include "sensor/recentred_source.h"

namespace patina::sensor {
namespace {

/// A float resolves 0.06 mm at this distance, which a map of voxels of millimetres needs.
constexpr double kFar_m = 1000;

}  // namespace

glm::dvec3 world_offset_m(glm::dvec3 first_camera_m) {
    return glm::length(first_camera_m) > kFar_m ? glm::round(first_camera_m) : glm::dvec3(0);
}

std::optional<Reading> RecentredSource::next() {
    std::optional<Reading> reading = source_->next();
    if (!reading) return reading;
    if (auto* frame = std::get_if<Frame>(&*reading); frame && frame->world_from_camera)
        (*frame->world_from_camera)[3] -= glm::dvec4(offset_m_, 0);
    return reading;
}

}  // namespace patina::sensor
