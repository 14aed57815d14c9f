#include "scenes/description/vary_path.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include <glm/trigonometric.hpp>

namespace patina::scenes {
namespace {

constexpr double kChange = 0.2;

/// The same views at other times, and what the views then turn into.
template <class Path>
struct Change {
    Path start;
    Path end;
};

double scale(Draws& draws) { return draws.between(1 - kChange, 1 + kChange); }

Change<OrbitPath> change_of(OrbitPath start, Draws& draws) {
    const double distance = scale(draws), azimuth = scale(draws), elevation = scale(draws);
    start.azimuth_phase_rad += draws.between(0, 2 * std::numbers::pi);
    start.elevation_phase_rad += draws.between(0, 2 * std::numbers::pi);
    start.azimuth_period_s *= std::max(1.0, distance * azimuth) * draws.between(1, 1 + kChange);
    start.elevation_period_s *= std::max(1.0, distance * elevation) * draws.between(1, 1 + kChange);
    OrbitPath end = start;
    end.distance_m *= distance;
    end.azimuth_rad += glm::radians(draws.between(-20, 20));
    end.azimuth_amplitude_rad *= azimuth;
    end.elevation_rad *= scale(draws);
    end.elevation_amplitude_rad *= elevation;
    return {start, end};
}

OrbitPath between(const Change<OrbitPath>& change, double share) {
    const auto& [start, end] = change;
    OrbitPath path = start;
    path.distance_m = std::lerp(start.distance_m, end.distance_m, share);
    path.azimuth_rad = std::lerp(start.azimuth_rad, end.azimuth_rad, share);
    path.azimuth_amplitude_rad = std::lerp(start.azimuth_amplitude_rad, end.azimuth_amplitude_rad, share);
    path.elevation_rad = std::lerp(start.elevation_rad, end.elevation_rad, share);
    path.elevation_amplitude_rad = std::lerp(start.elevation_amplitude_rad, end.elevation_amplitude_rad, share);
    return path;
}

Change<WaypointPath> change_of(WaypointPath start, Draws& draws) {
    std::vector<Waypoint>& points = start.waypoints;
    std::rotate(points.begin(), points.begin() + static_cast<std::ptrdiff_t>(draws.below(points.size())), points.end());
    if (draws.below(2) == 1) std::reverse(points.begin(), points.end());
    start.period_s *= draws.between(1 + kChange, 1 + 2 * kChange);  // shifted waypoints make a tour longer
    WaypointPath end = start;
    for (Waypoint& point : end.waypoints) {
        const double reach_m = kChange / 2 * glm::distance(point.position_m, point.target_m);
        point.position_m += reach_m * draws.in_ball();
        point.target_m += reach_m * draws.in_ball();
    }
    return {start, end};
}

WaypointPath between(const Change<WaypointPath>& change, double share) {
    WaypointPath path = change.start;
    for (size_t i = 0; i < path.waypoints.size(); ++i) {
        const Waypoint &start = change.start.waypoints[i], &end = change.end.waypoints[i];
        path.waypoints[i] = {glm::mix(start.position_m, end.position_m, share),
                             glm::mix(start.target_m, end.target_m, share)};
    }
    return path;
}

/// The two angles of an orbit have periods of their own: after some of the longer one, most pairs have come.
double duration_s(const OrbitPath& path) { return 8 * std::max(path.azimuth_period_s, path.elevation_period_s); }
double duration_s(const WaypointPath& path) { return path.period_s; }

struct Sample {
    glm::dvec3 position_m;
    double clearance_m;
};

template <class Path>
std::vector<Sample> samples_of(const Path& path, const Clearance& clearance) {
    constexpr int kSamples = 512;
    std::vector<Sample> samples;
    for (int i = 0; i < kSamples; ++i) {
        const glm::dvec3 position_m(world_from_camera(path, duration_s(path) * i / kSamples)[3]);
        samples.push_back({position_m, clearance.at(position_m)});
    }
    return samples;
}

double least_clearance_m(const std::vector<Sample>& samples) {
    return std::min_element(samples.begin(), samples.end(),
                            [](const Sample& a, const Sample& b) { return a.clearance_m < b.clearance_m; })
        ->clearance_m;
}

/// Whether each sample lies within the free space around its predecessor: then nothing was passed through.
bool near_enough(const std::vector<Sample>& before, const std::vector<Sample>& after) {
    return std::equal(before.begin(), before.end(), after.begin(), [](const Sample& a, const Sample& b) {
        return glm::distance(a.position_m, b.position_m) < a.clearance_m;
    });
}

/// Goes from the start towards the end in small steps for as long as the path stays good.
template <class Path>
Path furthest(const Change<Path>& change, const Clearance& clearance) {
    constexpr int kSteps = 16;
    Path path = change.start;
    std::vector<Sample> samples = samples_of(path, clearance);
    const double least_m = least_clearance_m(samples) / 2;
    for (int i = 1; i <= kSteps; ++i) {
        Path next = between(change, double(i) / kSteps);
        if (steepest_view(next).angle_rad > kSteepestView_rad) break;
        std::vector<Sample> next_samples = samples_of(next, clearance);
        if (least_clearance_m(next_samples) < least_m || !near_enough(samples, next_samples)) break;
        path = std::move(next);
        samples = std::move(next_samples);
    }
    return path;
}

}  // namespace

CameraPath varied(const CameraPath& path, Draws draws, const Clearance& clearance) {
    return std::visit([&](const auto& kind) -> CameraPath { return furthest(change_of(kind, draws), clearance); },
                      path);
}

}  // namespace patina::scenes
