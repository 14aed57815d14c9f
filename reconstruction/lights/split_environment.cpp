#include "reconstruction/lights/split_environment.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "engine/core/error.h"
#include "engine/core/latitude_longitude.h"
#include "engine/core/luminance.h"
#include "engine/core/octahedral.h"
#include "shared/reflectance/far_field.h"

namespace patina {

namespace {

constexpr double kBright = 4;            // times the mean luminance, from which on light is a lamp's
constexpr double kNarrow_rad = 0.04;     // a lamp whose light lies so near its middle is not divided,
constexpr double kWide_rad = 0.17;       // and one whose light lies farther from it is none
constexpr double kDividedShare = 1e-3;   // of all lamps' light times its spread squared, below which none is divided
constexpr uint32_t kMostColumns = 1024;  // of a picture; finer ones are averaged
constexpr uint32_t kSamples = 16;        // of a texel, along each side

/// No wider than kMostColumns, by means over squares of pixels.
Image<glm::vec3> made_small(const Image<glm::vec3>& picture) {
    const Extent2D from = picture.extent();
    const uint32_t edge = (from.width + kMostColumns - 1) / kMostColumns;
    if (edge <= 1) return picture;
    const Extent2D to{from.width / edge, std::max(from.height / edge, 1u)};
    Image<glm::vec3> small(to);
    for (uint32_t y = 0; y < to.height; ++y) {
        for (uint32_t x = 0; x < to.width; ++x) {
            const uint32_t x_end = (x + 1) * from.width / to.width, y_end = (y + 1) * from.height / to.height;
            glm::dvec3 sum(0);
            double pixels = 0;
            for (uint32_t v = y * from.height / to.height; v < y_end; ++v) {
                for (uint32_t u = x * from.width / to.width; u < x_end; ++u, ++pixels) sum += picture.at(u, v);
            }
            small.at(x, y) = glm::vec3(sum / std::max(pixels, 1.0));
        }
    }
    return small;
}

/// A pixel's light above the limit.
struct Bright {
    size_t pixel;
    glm::dvec3 direction;
    glm::dvec3 excess;  ///< radiance
    double sr;

    double weight() const { return luminance(excess) * sr; }
};

/// Takes what is above the limit out of the picture.
std::vector<Bright> take_bright(Image<glm::vec3>& picture, double limit) {
    std::vector<Bright> taken;
    const Extent2D extent = picture.extent();
    for (uint32_t y = 0; y < extent.height; ++y) {
        for (uint32_t x = 0; x < extent.width; ++x) {
            const glm::dvec3 radiance(picture.at(x, y));
            const double bright = luminance(radiance);
            if (bright <= limit) continue;
            const glm::dvec3 excess = radiance * (1 - limit / bright);
            picture.at(x, y) = glm::vec3(radiance - excess);
            taken.push_back({size_t{y} * extent.width + x, direction_of_place({x + 0.5, y + 0.5}, extent), excess,
                             solid_angle_of_row(y, extent)});
        }
    }
    return taken;
}

/// Bright pixels that one lamp stands for.
struct Cluster {
    std::span<Bright> pixels;
    glm::dvec3 irradiance{0};  ///< of a surface that faces it, about
    glm::dvec3 middle{0};      ///< the mean direction, shorter than 1
    glm::dvec3 variance{0};    ///< of directions, along each axis
    double weight = 0;

    double spread2() const { return variance.x + variance.y + variance.z; }
    /// What is lost where one lamp stands for all.
    double error() const { return pixels.size() > 1 && spread2() > kNarrow_rad * kNarrow_rad ? weight * spread2() : 0; }
};

Cluster cluster_of(std::span<Bright> pixels) {
    Cluster cluster{pixels};
    glm::dvec3 squares(0);
    for (const Bright& each : pixels) {
        cluster.irradiance += each.excess * each.sr;
        cluster.weight += each.weight();
        cluster.middle += each.weight() * each.direction;
        squares += each.weight() * each.direction * each.direction;
    }
    cluster.middle /= cluster.weight;
    cluster.variance = glm::max(squares / cluster.weight - cluster.middle * cluster.middle, 0.0);
    return cluster;
}

/// In two at its middle, across the axis along which it is widest; both have pixels.
std::pair<Cluster, Cluster> divided(const Cluster& cluster) {
    const glm::dvec3 v = cluster.variance;
    const int axis = v.x >= v.y && v.x >= v.z ? 0 : v.y >= v.z ? 1 : 2;
    const auto second = std::stable_partition(cluster.pixels.begin(), cluster.pixels.end(), [&](const Bright& each) {
        return each.direction[axis] < cluster.middle[axis];
    });
    const auto first = static_cast<size_t>(second - cluster.pixels.begin());
    return {cluster_of(cluster.pixels.first(first)), cluster_of(cluster.pixels.subspan(first))};
}

std::vector<Cluster> clusters_of(std::span<Bright> pixels, size_t most) {
    if (pixels.empty()) return {};
    std::vector<Cluster> clusters{cluster_of(pixels)};
    const double least = kDividedShare * kNarrow_rad * kNarrow_rad * clusters.front().weight;
    const auto by_error = [](const Cluster& a, const Cluster& b) { return a.error() < b.error(); };
    while (clusters.size() < most) {
        const auto worst = std::max_element(clusters.begin(), clusters.end(), by_error);
        if (worst->error() <= least) break;
        auto [first, second] = divided(*worst);
        *worst = first;
        clusters.push_back(second);
    }
    return clusters;
}

std::vector<glm::vec3> far_field_of(const Image<glm::vec3>& picture, const glm::dmat3& picture_from_world) {
    std::vector<glm::vec3> field;
    field.reserve(gpu::kFarFieldTexels);
    constexpr uint32_t kAcross = gpu::kFarFieldEdge * kSamples;
    for (uint32_t texel = 0; texel < gpu::kFarFieldTexels; ++texel) {
        const glm::uvec2 first(texel % gpu::kFarFieldEdge * kSamples, texel / gpu::kFarFieldEdge * kSamples);
        glm::dvec3 sum(0);
        for (uint32_t i = 0; i < kSamples * kSamples; ++i) {
            const glm::dvec2 at = glm::dvec2(first + glm::uvec2(i % kSamples, i / kSamples)) + 0.5;
            const glm::dvec3 direction = picture_from_world * direction_of_octahedral(at * (2.0 / kAcross) - 1.0);
            sum += picture.pixels()[pixel_of_direction(direction, picture.extent())];
        }
        field.emplace_back(sum / double{kSamples * kSamples});
    }
    return field;
}

}  // namespace

SplitEnvironment split_environment(const Image<glm::vec3>& picture, const glm::dmat3& picture_from_world,
                                   size_t most_lamps) {
    if (picture.pixels().empty()) throw Error("an environment has no pixels");
    Image<glm::vec3> rest = made_small(picture);
    std::vector<Bright> bright;
    if (most_lamps > 0) bright = take_bright(rest, kBright * mean_luminance(rest));
    const glm::dmat3 world_from_picture = glm::transpose(picture_from_world);
    SplitEnvironment split;
    for (const Cluster& cluster : clusters_of(bright, most_lamps)) {
        if (cluster.spread2() > kWide_rad * kWide_rad) {
            for (const Bright& each : cluster.pixels) rest.pixels()[each.pixel] += glm::vec3(each.excess);
            continue;
        }
        Light& lamp = split.lamps.emplace_back();
        lamp.position_m = kEnvironmentDistance_m * (world_from_picture * glm::normalize(cluster.middle));
        lamp.intensity = kEnvironmentDistance_m * kEnvironmentDistance_m * cluster.irradiance;
    }
    split.far_field = far_field_of(rest, picture_from_world);
    return split;
}

}  // namespace patina
