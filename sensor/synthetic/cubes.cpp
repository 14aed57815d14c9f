#include "sensor/synthetic/cubes.h"

#include <cmath>
#include <numbers>
#include <utility>

namespace patina::sensor {
namespace {

constexpr double kHalfEdge_m = 0.2;
constexpr glm::dvec3 kVertical(0, 1, 0);

constexpr double degrees(double value) { return value * std::numbers::pi / 180; }

/// Heights are counted upwards from the floor at y = 0, that is, towards negative y.
glm::dvec3 at_height(double x_m, double height_m, double z_m) { return {x_m, -height_m, z_m}; }

RigidTransform turned(glm::dvec3 center_m, double degrees_about_vertical) {
    return placed(center_m, kVertical, degrees(degrees_about_vertical));
}

/// Tilted about its own x axis by `tilt_degrees`, then turned about the vertical; its lowest edge touches the floor.
RigidTransform on_edge(double x_m, double z_m, double tilt_degrees, double turn_degrees) {
    const double tilt = degrees(tilt_degrees);
    const double height_m = kHalfEdge_m * (std::cos(tilt) + std::sin(tilt));
    return turned(at_height(x_m, height_m, z_m), turn_degrees) * placed(glm::dvec3(0), {1, 0, 0}, tilt);
}

/// A space diagonal stands upright; the lowest corner touches the floor.
RigidTransform on_corner(double x_m, double z_m, double turn_degrees) {
    const double half_diagonal_m = kHalfEdge_m * std::sqrt(3.0);
    const double tilt = std::acos(1 / std::sqrt(3.0));  // between the space diagonal and an edge
    return turned(at_height(x_m, half_diagonal_m, z_m), turn_degrees) * placed(glm::dvec3(0), {1, 0, -1}, tilt);
}

void add(Scene& scene, SceneObject object) {
    object.material.id = static_cast<uint32_t>(scene.objects.size() + 1);
    scene.objects.push_back(std::move(object));
}

void add_cube(Scene& scene, const RigidTransform& world_from_object, Material material) {
    add(scene, {{{BoxShape{glm::dvec3(kHalfEdge_m)}, world_from_object}}, std::move(material)});
}

Material material(const char* name, glm::dvec3 kd, glm::dvec3 ks, double alpha) { return {0, name, kd, ks, alpha}; }

void add_floor(Scene& scene) {
    const RigidTransform horizontal = placed(glm::dvec3(0), {1, 0, 0}, degrees(90));
    add(scene,
        {{{RectangleShape{{2.0, 2.0}}, horizontal}}, material("floor", {0.42, 0.40, 0.37}, glm::dvec3(0.05), 0.20)});
}

void add_upright_cubes(Scene& scene) {
    add_cube(scene, turned(at_height(-0.55, 0.2, 0.10), 20),
             material("red plastic", {0.55, 0.06, 0.05}, glm::dvec3(0.06), 0.12));
    add_cube(scene, turned(at_height(0.10, 0.2, -0.35), -15),
             material("blue gloss", {0.06, 0.13, 0.50}, glm::dvec3(0.06), 0.09));
    add_cube(scene, turned(at_height(0.60, 0.2, 0.25), 40),
             material("green satin", {0.10, 0.42, 0.12}, glm::dvec3(0.10), 0.20));
    add_cube(scene, turned(at_height(0.60, 0.6, 0.25), 10),
             material("yellow matt", {0.60, 0.47, 0.07}, glm::dvec3(0.03), 0.30));
    add_cube(scene, turned(at_height(-0.10, 0.2, 0.65), 60),
             material("brushed brass", {0.16, 0.11, 0.04}, {0.35, 0.26, 0.10}, 0.22));
}

void add_balanced_cubes(Scene& scene) {
    add_cube(scene, on_edge(-0.75, -0.70, 30, 35),
             material("white porcelain", {0.65, 0.65, 0.62}, glm::dvec3(0.05), 0.10));
    add_cube(scene, on_corner(0.75, -0.55, 25), material("violet paint", {0.30, 0.10, 0.40}, glm::dvec3(0.08), 0.15));
    add_cube(scene, on_edge(-1.25, -0.15, 55, -40),
             material("orange gloss", {0.60, 0.25, 0.04}, glm::dvec3(0.07), 0.11));
    add_cube(scene, on_edge(1.30, -0.05, 20, 75), material("grey metal", {0.12, 0.12, 0.13}, glm::dvec3(0.30), 0.18));
    add_cube(scene, on_corner(-0.75, 0.85, 70), material("teal satin", {0.05, 0.35, 0.36}, glm::dvec3(0.12), 0.22));
    add_cube(scene, on_edge(0.50, 0.95, 40, -20),
             material("black lacquer", {0.03, 0.03, 0.03}, glm::dvec3(0.06), 0.10));
    add_cube(scene, on_edge(0.00, -1.05, 45, 5), material("copper", {0.20, 0.08, 0.05}, {0.40, 0.20, 0.13}, 0.25));
}

}  // namespace

Scene make_cubes() {
    Scene scene;
    scene.name = "cubes";
    add_floor(scene);
    add_upright_cubes(scene);
    add_balanced_cubes(scene);
    scene.lights = {{at_height(-1.6, 2.4, -1.9), glm::dvec3(16.0, 15.2, 14.1)},
                    {at_height(2.3, 2.2, -0.4), glm::dvec3(12.8, 13.2, 13.9)},
                    {at_height(-0.5, 2.6, 2.2), glm::dvec3(14.4, 14.0, 13.7)}};
    // At most 1.0 m/s and 15 degrees/s: a person walking around the scene with a hand-held camera.
    scene.path = OrbitPath{.target_m = at_height(0, 0.2, 0),
                           .distance_m = 4,
                           .azimuth_amplitude_rad = degrees(120),
                           .azimuth_period_s = 60,
                           .elevation_rad = degrees(35),
                           .elevation_amplitude_rad = degrees(10),
                           .elevation_period_s = 9};
    return scene;
}

}  // namespace patina::sensor
