#include "sensor/pose_convention.h"

#include <algorithm>
#include <cmath>

#include "engine/core/error.h"
#include "sensor/files/text_file.h"

namespace patina::sensor {
namespace {

constexpr size_t kPoints = 2000;                          // of each frame that is compared
constexpr uint32_t kMostPairs = 60;                       // of frames: enough to be sure
constexpr uint32_t kLeastPairs = 3;                       // fewer tell nothing
constexpr double kLeastMove = 0.1, kLeastTurn_rad = 0.1;  // between two of a pair; the move over the mean depth
constexpr double kTolerance_m = 0.01, kTolerance = 0.01;  // of a depth reading, absolute and relative
// Of the points that agree: right poses have 0.6 to 0.95 of them on real recordings, so that nothing can be this much
// better.
constexpr double kLeastShare = 0.5, kLeastGain = 0.25;

/// A convention as bits: x, y and z turned over, poses inverted.
constexpr size_t kInverted = 8;

/// What a pose is in axes of which some are turned over.
RigidTransform turned_over(const RigidTransform& transform, size_t convention) {
    RigidTransform axes(1.0);
    for (int axis = 0; axis < 3; ++axis)
        if ((convention >> axis & 1u) != 0) axes[axis][axis] = -1;
    return axes * transform * axes;
}

RigidTransform relative_pose(const RigidTransform& a, const RigidTransform& b, size_t convention) {
    const bool inverted = (convention & kInverted) != 0;
    return turned_over(inverted ? b * rigid_inverse(a) : rigid_inverse(b) * a, convention);
}

double turn_between_rad(const RigidTransform& a, const RigidTransform& b) {
    const glm::dmat3 turn = glm::transpose(glm::dmat3(a)) * glm::dmat3(b);
    return std::acos(std::clamp((turn[0][0] + turn[1][1] + turn[2][2] - 1) / 2, -1.0, 1.0));
}

std::string name_of(size_t convention) {
    constexpr const char* kAxes[kInverted] = {
        "",
        "those of a left-handed world, its x axis mirrored",
        "those of a left-handed world, its y axis mirrored (as with y up in Unity)",
        "those of a camera whose x and y axes are turned over",
        "those of a left-handed world, its z axis mirrored",
        "those of a camera whose x and z axes are turned over",
        "those of a camera whose y axis points up and z axis backward (as in OpenGL)",
        "those of a left-handed world, all its axes mirrored"};
    const std::string axes = kAxes[convention % kInverted];
    if (convention < kInverted) return "like " + axes;
    return "inverted (world-to-camera)" + (axes.empty() ? axes : ", and like " + axes);
}

}  // namespace

PoseConventionCheck::PoseConventionCheck(const SequenceInfo& info) : info_(info) {}

void PoseConventionCheck::remember_depth(const Frame& frame) {
    const auto keep = [&](const auto& image, double metres) {
        depth_m_ = Image<float>(image.extent());
        std::ranges::transform(image.pixels(), depth_m_.pixels().begin(), [&](auto reading) {
            const double z = static_cast<double>(reading) * metres;
            return std::isfinite(z) && z > 0 && z < info_.max_metres ? static_cast<float>(z) : 0.0f;
        });
    };
    if (const auto* units = std::get_if<Image<uint16_t>>(&frame.depth)) keep(*units, info_.metres_per_unit);
    if (const auto* metres = std::get_if<Image<float>>(&frame.depth)) keep(*metres, 1);
}

std::optional<PoseConventionCheck::Kept> PoseConventionCheck::kept_of(const Frame& frame) const {
    Kept kept{*frame.world_from_camera, {}, 0};
    const Extent2D extent = depth_m_.extent();
    const auto stride = static_cast<uint32_t>(
        std::max(1.0, std::floor(std::sqrt(static_cast<double>(extent.area()) / static_cast<double>(kPoints)))));
    for (uint32_t y = stride / 2; y < extent.height; y += stride) {
        for (uint32_t x = stride / 2; x < extent.width; x += stride) {
            const double z = double{depth_m_.at(x, y)};
            if (z == 0) continue;
            const glm::dvec2 ray((x - info_.depth.cx) / info_.depth.fx, (y - info_.depth.cy) / info_.depth.fy);
            kept.points_m.emplace_back(ray * z, z);
            kept.mean_depth_m += z;
        }
    }
    if (kept.points_m.empty()) return std::nullopt;
    kept.mean_depth_m /= static_cast<double>(kept.points_m.size());
    return kept;
}

/// Points that leave the picture disagree: of frames so near each other most stay.
PoseConventionCheck::Measured PoseConventionCheck::measured_at(glm::dvec3 point_m) const {
    if (point_m.z <= 0) return Measured::kDisagrees;
    const double x = std::floor(point_m.x / point_m.z * info_.depth.fx + info_.depth.cx + 0.5);
    const double y = std::floor(point_m.y / point_m.z * info_.depth.fy + info_.depth.cy + 0.5);
    const Extent2D extent = depth_m_.extent();
    if (!(x >= 0 && y >= 0 && x < extent.width && y < extent.height)) return Measured::kDisagrees;
    const double measured_m = double{depth_m_.at(static_cast<uint32_t>(x), static_cast<uint32_t>(y))};
    if (measured_m == 0) return Measured::kNothing;
    const bool agrees = std::abs(point_m.z - measured_m) < kTolerance_m + kTolerance * measured_m;
    return agrees ? Measured::kAgrees : Measured::kDisagrees;
}

void PoseConventionCheck::compare(const Kept& from, const Kept& to) {
    for (size_t convention = 0; convention < kConventions; ++convention) {
        const RigidTransform to_from_from = relative_pose(from.world_from_camera, to.world_from_camera, convention);
        for (const glm::dvec3& point_m : from.points_m) {
            const Measured measured = measured_at(glm::dvec3(to_from_from * glm::dvec4(point_m, 1)));
            counts_[convention].agreeing += measured == Measured::kAgrees;
            counts_[convention].comparable += measured != Measured::kNothing;
        }
    }
    ++pairs_;
}

void PoseConventionCheck::add(const Frame& frame) {
    if (!frame.world_from_camera || pairs_ == kMostPairs) return;
    if (last_) {
        const RigidTransform& before = last_->world_from_camera;
        const double move_m = glm::distance(glm::dvec3(before[3]), glm::dvec3((*frame.world_from_camera)[3]));
        const bool far = move_m > kLeastMove * last_->mean_depth_m ||
                         turn_between_rad(before, *frame.world_from_camera) > kLeastTurn_rad;
        if (!far) return;
    }
    remember_depth(frame);
    std::optional<Kept> kept = kept_of(frame);
    if (!kept) return;
    if (last_) compare(*last_, *kept);
    last_ = std::move(kept);
}

std::optional<std::string> PoseConventionCheck::complaint() const {
    if (pairs_ < kLeastPairs) return std::nullopt;
    const auto best_count = std::ranges::max_element(counts_, {}, [](const Count& count) { return count.share(); });
    const double best = best_count->share(), given = counts_.front().share();
    if (best < kLeastShare || best < given + kLeastGain) return std::nullopt;
    return text(
        "the poses look ", name_of(static_cast<size_t>(best_count - counts_.begin())), ": then ", fixed(100 * best, 0),
        " % of the depth readings agree from frame to frame, as they are ", fixed(100 * given, 0),
        " %; give camera-to-world poses with axes x right, y down, z forward, or track the camera without them");
}

}  // namespace patina::sensor
