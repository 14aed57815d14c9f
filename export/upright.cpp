#include "export/upright.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace patina {

namespace {

/// Of a plane's patches: a fused surface is rough by that.
const double kConeCosine = std::cos(glm::radians(6.0));
const double kLevelCosine = std::cos(glm::radians(12.0));
const double kNearCosine = std::cos(glm::radians(20.0)), kFarCosine = std::cos(glm::radians(60.0));
const double kMostRoll = std::sin(glm::radians(10.0));
constexpr double kLeastShare = 0.05;  // of the surface, that makes a plane
constexpr double kFarWeight = 0.5;    // of a plane's area, where the cameras' mean up is more than 20 degrees off
constexpr double kLayer_m = 0.03;     // half a floor's thickness: three voxels of 1 cm
constexpr double kLeastFloor = 0.25;  // of the largest level layer
constexpr double kLowest = 0.01;      // of the surface, that may be below the floor where there is no layer

/// Area by direction, on the faces of a cube in steps of some 3 degrees.
class DirectionHistogram {
  public:
    explicit DirectionHistogram(std::span<const Patch> patches) : sums_(6 * kSteps * kSteps) {
        for (const Patch& patch : patches) {
            sums_[bin_of(glm::dvec3(patch.area_m2))] += glm::dvec3(patch.area_m2);
            total_m2_ += glm::length(glm::dvec3(patch.area_m2));
        }
    }
    double total_m2() const { return total_m2_; }
    /// By direction, each the sum of area vectors; zero where there are none.
    std::span<const glm::dvec3> sums() const { return sums_; }
    /// What lies around a direction of unit length.
    glm::dvec3 sum_around(glm::dvec3 direction) const {
        glm::dvec3 sum(0);
        for (const glm::dvec3& each : sums_)
            if (glm::dot(each, direction) > kConeCosine * glm::length(each)) sum += each;
        return sum;
    }

  private:
    static constexpr int kSteps = 32;

    static size_t bin_of(glm::dvec3 v) {
        const glm::dvec3 size = glm::abs(v);
        const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        const auto step = [&](int other) {
            const double at = v[other] / size[axis] * 0.5 + 0.5;
            return static_cast<size_t>(std::clamp(static_cast<int>(at * kSteps), 0, kSteps - 1));
        };
        const size_t face = static_cast<size_t>(2 * axis) + (v[axis] < 0);
        return (face * kSteps + step((axis + 1) % 3)) * kSteps + step((axis + 2) % 3);
    }

    std::vector<glm::dvec3> sums_;
    double total_m2_ = 0;
};

/// The root of the mean square of how far the cameras are rolled if `up` is up.
double roll_of(std::span<const RigidTransform> cameras, glm::dvec3 up) {
    double sum = 0;
    for (const RigidTransform& pose : cameras)
        sum += glm::dot(glm::dvec3(pose[0]), up) * glm::dot(glm::dvec3(pose[0]), up);
    return std::sqrt(sum / static_cast<double>(cameras.size()));
}

/// How much a plane's area counts that is level if `up` is up; 0: it cannot be.
double weight_of(std::span<const RigidTransform> cameras, glm::dvec3 cameras_up, glm::dvec3 up) {
    const double cosine = glm::dot(cameras_up, up);
    if (cosine >= kNearCosine) return 1;
    return cosine >= kFarCosine && roll_of(cameras, up) <= kMostRoll ? kFarWeight : 0;
}

/// The mean normal of the patches around a direction.
glm::dvec3 refined(glm::dvec3 direction, std::span<const Patch> patches) {
    constexpr int kSteps = 5;
    for (int i = 0; i < kSteps; ++i) {
        glm::dvec3 sum(0);
        for (const Patch& patch : patches) {
            const glm::dvec3 area_m2(patch.area_m2);
            if (glm::dot(area_m2, direction) > kConeCosine * glm::length(area_m2)) sum += area_m2;
        }
        if (glm::length(sum) > 0) direction = glm::normalize(sum);
    }
    return direction;
}

/// The normal of the largest plane that may be level; empty where none is.
std::optional<glm::dvec3> level_normal(std::span<const RigidTransform> cameras, glm::dvec3 cameras_up,
                                       std::span<const Patch> patches) {
    const DirectionHistogram histogram(patches);
    double most = 0;
    glm::dvec3 best(0);
    for (const glm::dvec3& sum : histogram.sums()) {
        if (sum == glm::dvec3(0)) continue;
        const glm::dvec3 direction = glm::normalize(sum);
        const double weight = weight_of(cameras, cameras_up, direction);
        if (weight == 0) continue;
        const double area_m2 = glm::length(histogram.sum_around(direction));
        if (area_m2 < kLeastShare * histogram.total_m2() || weight * area_m2 <= most) continue;
        most = weight * area_m2;
        best = direction;
    }
    if (most == 0) return std::nullopt;
    return refined(best, patches);
}

/// Heights with the areas that lie there, ascending.
using Heights = std::vector<std::pair<double, double>>;

Heights heights_of(glm::dquat y_up_from_world, std::span<const Patch> patches, double least_cosine, double below_m) {
    Heights heights;
    for (const Patch& patch : patches) {
        const double area_m2 = glm::length(glm::dvec3(patch.area_m2));
        const double height_m = (y_up_from_world * glm::dvec3(patch.center_m)).y;
        if ((y_up_from_world * glm::dvec3(patch.area_m2)).y >= least_cosine * area_m2 && height_m < below_m)
            heights.emplace_back(height_m, area_m2);
    }
    std::ranges::sort(heights);
    return heights;
}

/// The area within kLayer_m of each height, and its mean height.
Heights layers_of(const Heights& heights) {
    Heights layers;
    size_t first = 0, end = 0;
    double area_m2 = 0, moment = 0;
    for (const auto& [height_m, own_m2] : heights) {
        for (; end < heights.size() && heights[end].first <= height_m + kLayer_m; ++end) {
            area_m2 += heights[end].second;
            moment += heights[end].first * heights[end].second;
        }
        for (; heights[first].first < height_m - kLayer_m; ++first) {
            area_m2 -= heights[first].second;
            moment -= heights[first].first * heights[first].second;
        }
        layers.emplace_back(moment / area_m2, area_m2);
    }
    return layers;
}

/// The mean height of the lowest layer that is large enough: of the heights from its first on, the one around which
/// there is most.
std::optional<double> lowest_layer(const Heights& heights) {
    const Heights layers = layers_of(heights);
    const auto by_area = [](const auto& a, const auto& b) { return a.second < b.second; };
    const auto largest = std::ranges::max_element(layers, by_area);
    if (largest == layers.end()) return std::nullopt;
    const auto first =
        std::ranges::find_if(layers, [&](const auto& layer) { return layer.second >= kLeastFloor * largest->second; });
    auto end = first;
    while (end != layers.end() && end->first <= first->first + 2 * kLayer_m) ++end;
    return std::max_element(first, end, by_area)->first;
}

double quantile(const Heights& heights, double share) {
    double total_m2 = 0, sum_m2 = 0;
    for (const auto& height : heights) total_m2 += height.second;
    for (const auto& [height_m, area_m2] : heights) {
        sum_m2 += area_m2;
        if (sum_m2 >= share * total_m2) return height_m;
    }
    return 0;
}

double camera_height(glm::dquat y_up_from_world, std::span<const RigidTransform> cameras) {
    if (cameras.empty()) return std::numeric_limits<double>::infinity();
    double sum_m = 0;
    for (const RigidTransform& pose : cameras) sum_m += (y_up_from_world * glm::dvec3(pose[3])).y;
    return sum_m / static_cast<double>(cameras.size());
}

double floor_height(glm::dquat y_up_from_world, const UpHints& hints, std::span<const Patch> patches) {
    const double cameras_m = camera_height(y_up_from_world, hints.cameras);
    const Heights level = heights_of(y_up_from_world, patches, kLevelCosine, cameras_m);
    if (const auto floor_m = lowest_layer(level)) return *floor_m;
    return quantile(heights_of(y_up_from_world, patches, -1.1, std::numeric_limits<double>::infinity()), kLowest);
}

std::pair<glm::dvec3, UpSource> find_up(const UpHints& hints, std::span<const Patch> patches) {
    if (hints.up) return {*hints.up, UpSource::kOption};
    if (hints.gravity) return {-*hints.gravity, UpSource::kGravity};
    const auto cameras_up = mean_up(hints.cameras);
    if (!cameras_up) return {glm::dvec3(0, -1, 0), UpSource::kNothing};
    if (const auto normal = level_normal(hints.cameras, *cameras_up, patches)) return {*normal, UpSource::kFloor};
    return {*cameras_up, UpSource::kCameras};
}

/// The shortest rotation from one direction of unit length to another that is not its opposite.
glm::dquat shortest(glm::dvec3 from, glm::dvec3 to) {
    return glm::normalize(glm::dquat(1 + glm::dot(from, to), glm::cross(from, to)));
}

}  // namespace

const char* name_of(UpSource source) {
    constexpr std::array kNames{"option", "gravity", "floor", "cameras", "nothing"};
    return kNames[static_cast<size_t>(source)];
}

RigidTransform Upright::gltf_from_world() const {
    RigidTransform transform(glm::mat4_cast(y_up_from_world));
    transform[3] = glm::dvec4(0, -floor_m, 0, 1);
    return transform;
}

std::optional<glm::dvec3> mean_up(std::span<const RigidTransform> cameras) {
    constexpr double kLevel = 1e-3;  // a mean square of x axes along up that is level enough: 2 degrees
    const double count = static_cast<double>(cameras.size());
    glm::dvec3 mean(0);
    glm::dmat3 squares(kLevel);
    for (const RigidTransform& pose : cameras) {
        const glm::dvec3 x(pose[0]), down(pose[1]);
        mean -= down / count;
        squares += glm::outerProduct(x, x) / count;
    }
    if (glm::length(mean) < 1e-3) return std::nullopt;
    return glm::normalize(glm::inverse(squares) * mean);
}

glm::dquat y_up_from(glm::dvec3 up) {
    up = glm::normalize(up);
    const glm::dvec3 size = glm::abs(up);
    const double quarter = std::sqrt(0.5);
    glm::dquat turn(1, 0, 0, 0);  // w, x, y, z
    if (size.y >= size.x && size.y >= size.z) {
        if (up.y < 0) turn = kYDownToYUp;
    } else if (size.z >= size.x) {
        turn = glm::dquat(quarter, up.z > 0 ? -quarter : quarter, 0, 0);
    } else {
        turn = glm::dquat(quarter, 0, 0, up.x > 0 ? quarter : -quarter);
    }
    return glm::normalize(shortest(turn * up, {0, 1, 0}) * turn);
}

Upright find_upright(const UpHints& hints, std::span<const Patch> patches) {
    Upright upright;
    glm::dvec3 up;
    std::tie(up, upright.source) = find_up(hints, patches);
    upright.y_up_from_world = y_up_from(up);
    upright.floor_m = floor_height(upright.y_up_from_world, hints, patches);
    return upright;
}

}  // namespace patina
