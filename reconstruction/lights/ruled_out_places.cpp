#include "reconstruction/lights/ruled_out_places.h"

#include <algorithm>

#include "reconstruction/lights/surface_samples.h"

namespace patina {
namespace {

constexpr size_t kMostViews = 256;  // a sixteenth of a lamp's samples: what trying takes grows by as much
constexpr float kBorder = 0.03f;    // of a picture, in which a lamp may be cut off
constexpr int kLeastViews = 2;      // one may be of a wrong pose

constexpr float kCarrierBehind_m = 0.8f, kCarrierReach_m = 0.4f;  // an arm's length, and half a person's width

gpu::LightSample view_of(const gpu::Camera& camera) {
    const glm::mat3 world_from_camera = glm::transpose(glm::mat3(camera.camera_from_world));
    gpu::LightSample view{};
    view.point_m = glm::vec4(-(world_from_camera * glm::vec3(camera.camera_from_world[3])), 1);
    view.normal = glm::vec4(world_from_camera[2], 0);
    return view;
}

}  // namespace

bool is_in_picture(const gpu::Camera& camera, glm::vec3 point_m) {
    const glm::vec3 p(camera.camera_from_world * glm::vec4(point_m, 1));
    if (p.z < gpu::kNearestDepth) return false;
    const glm::vec2 extent(camera.extent), border = kBorder * extent;
    const glm::vec2 px(camera.focal_center_px.x * p.x / p.z + camera.focal_center_px.z,
                       camera.focal_center_px.y * p.y / p.z + camera.focal_center_px.w);
    return glm::all(glm::greaterThan(px, border)) && glm::all(glm::lessThan(px, extent - border));
}

bool is_carrier(const gpu::Camera& camera, glm::vec3 point_m) {
    const glm::vec3 p(camera.camera_from_world * glm::vec4(point_m, 1));
    return glm::distance(p, glm::vec3(0, 0, std::clamp(p.z, -kCarrierBehind_m, 0.0f))) < kCarrierReach_m;
}

RuledOutPlaces::RuledOutPlaces(Pipeline& pipeline, std::span<const gpu::Camera> cameras) : pipeline_(pipeline) {
    const size_t count = std::min(cameras.size(), kMostViews);
    for (size_t i = 0; i < count; ++i) {
        cameras_.push_back(cameras[i * cameras.size() / count]);
        views_.push_back(view_of(cameras_.back()));
    }
}

std::vector<bool> RuledOutPlaces::operator()(std::span<const glm::vec3> places_m) const {
    const std::vector<float> open = try_lamps(pipeline_, views_, places_m);
    std::vector<bool> ruled_out;
    ruled_out.reserve(places_m.size());
    for (size_t i = 0; i < places_m.size(); ++i) {
        int views = 0;
        for (size_t v = 0; v < cameras_.size(); ++v) {
            const bool shown = open[i * cameras_.size() + v] > 0 && is_in_picture(cameras_[v], places_m[i]);
            views += shown || is_carrier(cameras_[v], places_m[i]);
        }
        ruled_out.push_back(views >= kLeastViews);
    }
    return ruled_out;
}

}  // namespace patina
