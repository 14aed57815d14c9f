#include "export/upright.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

namespace patina {

namespace {

/// Of a plane's patches: a fused surface is rough by that.
const double kConeCosine = std::cos(glm::radians(6.0)), kConeSine = std::sin(glm::radians(6.0));
const double kLevelCosine = std::cos(glm::radians(12.0));
/// Of cameras against up. Tried on one room, from 3 frames to 60, and four other recordings: docs/log/changes.md.
const double kUsualTilt = glm::radians(15.0), kTiltDeviation = glm::radians(40.0), kMostTilt = glm::radians(60.0);
const double kRollDeviation = glm::radians(20.0), kMostRoll = glm::radians(30.0);
constexpr double kUprightPart = 0.25;      // of what level surface counts: things stand at all angles about up
constexpr double kLeastFloorShare = 0.03;  // of the surface, that speaks for up
constexpr double kLeastLevel = 0.005;      // of the surface, that is level
constexpr double kLayer_m = 0.03;          // half a floor's thickness: three voxels of 1 cm
constexpr double kLeastFloor = 0.25;       // of the largest level layer
constexpr double kLowest = 0.01;           // of the surface, that may be below the floor where there is no layer

/// Area by direction, on the faces of a cube in steps of some 3 degrees.
class DirectionHistogram {
  public:
    /// A direction, of unit length, and the area that faces there.
    struct Bin {
        glm::dvec3 direction{0};
        double area_m2 = 0;
    };

    explicit DirectionHistogram(std::span<const Patch> patches) {
        std::vector<glm::dvec3> sums(6 * kSteps * kSteps);
        for (const Patch& patch : patches) sums[bin_of(glm::dvec3(patch.area_m2))] += glm::dvec3(patch.area_m2);
        for (const glm::dvec3& sum : sums) {
            if (sum == glm::dvec3(0)) continue;
            bins_.push_back({glm::normalize(sum), glm::length(sum)});
            total_m2_ += glm::length(sum);
        }
    }
    double total_m2() const { return total_m2_; }
    std::span<const Bin> bins() const { return bins_; }

    /// How much of the surface is level if `up` is up, and how much stands upright beyond what surface without any
    /// order has: of directions at random, the sine of the cone's angle is so near to level.
    std::pair<double, double> areas(glm::dvec3 up) const {
        double level_m2 = 0, upright_m2 = -kConeSine * total_m2_;
        for (const Bin& bin : bins_) {
            const double cosine = glm::dot(bin.direction, up);
            if (cosine > kConeCosine) level_m2 += bin.area_m2;
            if (std::abs(cosine) < kConeSine) upright_m2 += bin.area_m2;
        }
        return {level_m2, std::max(upright_m2, 0.0)};
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

    std::vector<Bin> bins_;
    double total_m2_ = 0;
};

/// The root of the mean square of how far the cameras are rolled if `up` is up.
double roll_of(std::span<const RigidTransform> cameras, glm::dvec3 up) {
    double sum = 0;
    for (const RigidTransform& pose : cameras)
        sum += glm::dot(glm::dvec3(pose[0]), up) * glm::dot(glm::dvec3(pose[0]), up);
    return std::sqrt(sum / static_cast<double>(cameras.size()));
}

/// From a likelihood of 1: how much the surface counts that speaks for `up`; 0: it cannot be up. A hand tilts a camera
/// by up to kUsualTilt at random; more is rarer, and a roll rarer than a tilt.
double weight_of(std::span<const RigidTransform> cameras, glm::dvec3 cameras_up, glm::dvec3 up) {
    const double tilt = std::acos(std::clamp(glm::dot(cameras_up, up), -1.0, 1.0));
    if (tilt > kMostTilt) return 0;
    const double roll = std::asin(std::min(roll_of(cameras, up), 1.0));
    if (roll > kMostRoll) return 0;
    const double unusual = std::max(tilt - kUsualTilt, 0.0) / kTiltDeviation, rolled = roll / kRollDeviation;
    return std::exp(-0.5 * (unusual * unusual + rolled * rolled));
}

/// The direction that level patches face and that upright ones are across, by least squares of their areas.
glm::dvec3 refined(glm::dvec3 up, std::span<const Patch> patches) {
    constexpr int kRounds = 5;
    for (int round = 0; round < kRounds; ++round) {
        glm::dvec3 level_m2(0);
        glm::dmat3 across_m2(0);
        for (const Patch& patch : patches) {
            const glm::dvec3 vector_m2(patch.area_m2);
            const double area_m2 = glm::length(vector_m2), cosine = glm::dot(vector_m2, up) / area_m2;
            if (cosine > kConeCosine) {
                level_m2 += vector_m2;
                across_m2 += glm::dmat3(area_m2);
            } else if (std::abs(cosine) < kConeSine) {
                across_m2 += glm::outerProduct(vector_m2, vector_m2) * (kUprightPart / area_m2);
            }
        }
        if (level_m2 == glm::dvec3(0)) break;
        up = glm::normalize(glm::inverse(across_m2) * level_m2);
    }
    return up;
}

/// The direction with the most surface that is level or upright if it is up; empty where there is too little.
std::optional<glm::dvec3> up_of_planes(std::span<const RigidTransform> cameras, glm::dvec3 cameras_up,
                                       std::span<const Patch> patches) {
    const DirectionHistogram histogram(patches);
    double most = 0;
    glm::dvec3 best(0);
    for (const DirectionHistogram::Bin& bin : histogram.bins()) {
        const double weight = weight_of(cameras, cameras_up, bin.direction);
        if (weight == 0) continue;
        const auto [level_m2, upright_m2] = histogram.areas(bin.direction);
        if (level_m2 < kLeastLevel * histogram.total_m2()) continue;
        const double support_m2 = level_m2 + kUprightPart * upright_m2;
        if (support_m2 < kLeastFloorShare * histogram.total_m2() || weight * support_m2 <= most) continue;
        most = weight * support_m2;
        best = bin.direction;
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
    if (const auto up = up_of_planes(hints.cameras, *cameras_up, patches)) return {*up, UpSource::kFloor};
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
