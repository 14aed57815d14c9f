#include "tools/eval/seen_surface.h"

#include <algorithm>
#include <limits>

#include "engine/core/error.h"

namespace patina::eval {
namespace {

/// Unique within 20 km of the origin.
uint64_t key_of(glm::dvec3 point_m) {
    constexpr int64_t kHalf = int64_t{1} << 20;
    uint64_t key = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const auto cell = static_cast<int64_t>(std::floor(point_m[axis] / SeenSurface::kCell_m));
        key = key << 21 | static_cast<uint64_t>(std::clamp(cell + kHalf, int64_t{0}, 2 * kHalf - 1));
    }
    return key;
}

/// Whether a point in the camera's axes lies where the (up to four) readings around its pixel are.
bool sees(const DepthView& view, glm::dvec3 point_m) {
    if (!(point_m.z > 0)) return false;
    const glm::dvec2 pixel = project(view.camera, point_m);
    const Extent2D extent = view.depth_m.extent();
    if (!(pixel.x >= -0.5 && pixel.y >= -0.5 && pixel.x < extent.width - 0.5 && pixel.y < extent.height - 0.5)) {
        return false;
    }
    const int x0 = static_cast<int>(std::floor(pixel.x)), y0 = static_cast<int>(std::floor(pixel.y));
    double nearest = std::numeric_limits<double>::infinity(), farthest = 0;
    for (int y = y0; y <= y0 + 1; ++y) {
        for (int x = x0; x <= x0 + 1; ++x) {
            if (!extent.contains(x, y)) continue;
            const double reading = view.depth_m.at(static_cast<uint32_t>(x), static_cast<uint32_t>(y));
            if (!(reading > 0)) continue;
            nearest = std::min(nearest, reading);
            farthest = std::max(farthest, reading);
        }
    }
    return point_m.z >= nearest - SeenSurface::kTolerance_m && point_m.z <= farthest + SeenSurface::kTolerance_m;
}

}  // namespace

void SeenSurface::add(glm::dvec3 point_m) {
    const auto next = static_cast<uint32_t>(cells_.size());
    if (!index_of_.try_emplace(key_of(point_m), next).second) return;
    cells_.push_back({point_m});
    unseen_.push_back(next);
}

void SeenSurface::count(uint32_t frame, const DepthView& view) {
    const RigidTransform camera_from_world = rigid_inverse(view.world_from_camera);
    std::erase_if(unseen_, [&](uint32_t index) {
        Cell& cell = cells_[index];
        if (!sees(view, glm::dvec3(camera_from_world * glm::dvec4(cell.point_m, 1)))) return false;
        if (++cell.frames < least_frames_) return false;
        cell.seen_since = frame;
        return true;
    });
}

bool SeenSurface::is_seen(glm::dvec3 point_m, uint32_t frame) const {
    const auto found = index_of_.find(key_of(point_m));
    PATINA_ASSERT(found != index_of_.end(), "point ", point_m.x, ' ', point_m.y, ' ', point_m.z);
    return cells_[found->second].seen_since <= frame;
}

}  // namespace patina::eval
