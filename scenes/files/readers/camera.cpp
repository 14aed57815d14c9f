#include "scenes/files/readers/camera.h"

#include <cmath>
#include <cstdint>

#include <glm/trigonometric.hpp>

#include "engine/core/error.h"
#include "scenes/files/readers/values.h"
#include "sensor/pose.h"

namespace patina::scenes {
namespace {

constexpr uint32_t kLargestExtent_px = 16384;

uint32_t read_pixels(const sensor::JsonValue& value) {
    if (value.positive_integer() > kLargestExtent_px) value.fail(text("must be at most ", kLargestExtent_px));
    return value.positive_integer();
}

Intrinsics read_camera(const sensor::JsonValue& value) {
    value.expect_keys({"width", "height", "fx", "fy", "cx", "cy"});
    Intrinsics camera;
    camera.extent = {read_pixels(value.at("width")), read_pixels(value.at("height"))};
    camera.fx = read_positive(value.at("fx"));
    camera.fy = read_positive(value.at("fy"));
    camera.cx = value.at("cx").number_within(-kLargestValue, kLargestValue);
    camera.cy = value.at("cy").number_within(-kLargestValue, kLargestValue);
    return camera;
}

ColorCamera read_color_camera(const sensor::JsonValue& value) {
    value.expect_keys({"camera", "color_from_depth"});
    const sensor::JsonValue pose = value.at("color_from_depth");
    return {read_camera(value.at("camera")),
            sensor::checked_pose(sensor::matrix_from_rows(pose.numbers(16)), pose.where()).transform};
}

/// Depth pictures hold 16-bit units.
void read_depth(const sensor::JsonValue& value, SyntheticScene& scene) {
    value.expect_keys({"metres_per_unit", "max_metres"});
    if (const auto unit = value.find("metres_per_unit")) scene.metres_per_unit = read_positive(*unit);
    if (const auto most = value.find("max_metres")) scene.max_metres = read_positive(*most);
    const double representable_m = UINT16_MAX * scene.metres_per_unit;
    if (scene.max_metres > representable_m) {
        throw Error(value.where(), ".max_metres is ", scene.max_metres, ", but 65535 units of ", scene.metres_per_unit,
                    " m reach ", representable_m, " m");
    }
}

struct Oscillation {
    double mean_rad = 0;
    double amplitude_rad = 0;
    double period_s = 1;
    double phase_rad = 0;
};

Oscillation read_oscillation(const sensor::JsonValue& value) {
    if (!value.is_object()) return {.mean_rad = read_degrees(value)};
    value.expect_keys({"mean", "amplitude", "period_s", "phase"});
    Oscillation oscillation;
    if (const auto mean = value.find("mean")) oscillation.mean_rad = read_degrees(*mean);
    if (const auto amplitude = value.find("amplitude")) {
        oscillation.amplitude_rad = read_degrees(*amplitude);
        oscillation.period_s = read_positive(value.at("period_s"));
    }
    if (const auto phase = value.find("phase")) oscillation.phase_rad = read_degrees(*phase);
    return oscillation;
}

OrbitPath read_orbit(const sensor::JsonValue& value) {
    value.expect_keys({"target", "distance", "azimuth_degrees", "elevation_degrees"});
    Oscillation azimuth, elevation;
    if (const auto angle = value.find("azimuth_degrees")) azimuth = read_oscillation(*angle);
    if (const auto angle = value.find("elevation_degrees")) elevation = read_oscillation(*angle);
    return {.target_m = read_vector(value.at("target")),
            .distance_m = read_positive(value.at("distance")),
            .azimuth_rad = azimuth.mean_rad,
            .azimuth_amplitude_rad = azimuth.amplitude_rad,
            .azimuth_period_s = azimuth.period_s,
            .azimuth_phase_rad = azimuth.phase_rad,
            .elevation_rad = elevation.mean_rad,
            .elevation_amplitude_rad = elevation.amplitude_rad,
            .elevation_period_s = elevation.period_s,
            .elevation_phase_rad = elevation.phase_rad};
}

WaypointPath read_tour(const sensor::JsonValue& value) {
    value.expect_keys({"period_s", "waypoints"});
    WaypointPath tour;
    tour.period_s = read_positive(value.at("period_s"));
    const sensor::JsonValue waypoints = value.at("waypoints");
    for (const sensor::JsonValue& waypoint : waypoints.elements()) {
        waypoint.expect_keys({"position", "target"});
        tour.waypoints.push_back({read_vector(waypoint.at("position")), read_vector(waypoint.at("target"))});
    }
    if (tour.waypoints.size() < 2) waypoints.fail(text("must hold at least 2 waypoints, not ", tour.waypoints.size()));
    return tour;
}

CameraPath read_path(const sensor::JsonValue& value) {
    const auto [kind, settings] = read_kind(value, {"orbit", "tour"});
    const CameraPath path = kind == "orbit" ? CameraPath(read_orbit(settings)) : CameraPath(read_tour(settings));
    const SteepestView view = steepest_view(path);
    if (!(view.angle_rad <= kSteepestView_rad)) {
        throw Error(settings.where(), " looks ", glm::degrees(view.angle_rad), " degrees up or down after ",
                    view.time_s, " s, must stay within ", glm::degrees(kSteepestView_rad));
    }
    return path;
}

LightingRecording read_lighting(const sensor::JsonValue& value) {
    value.expect_keys({"path", "frames"});
    LightingRecording lighting{.path = read_path(value.at("path"))};
    if (const auto frames = value.find("frames")) lighting.frames = frames->positive_integer();
    return lighting;
}

}  // namespace

void read_cameras(const sensor::JsonValue& root, SyntheticScene& scene) {
    if (const auto fps = root.find("fps")) scene.fps = read_positive(*fps);
    if (const auto camera = root.find("camera")) scene.camera = read_camera(*camera);
    if (const auto camera = root.find("color_camera")) scene.color_camera = read_color_camera(*camera);
    if (const auto depth = root.find("depth")) read_depth(*depth, scene);
    scene.path = read_path(root.at("path"));
    if (const auto lighting = root.find("lighting")) scene.lighting = read_lighting(*lighting);
}

}  // namespace patina::scenes
