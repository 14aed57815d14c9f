#include "scenes/description/scene.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/core/error.h"
#include "scenes/files/scene_file.h"
#include "tests/scenes/part_box.h"

namespace patina::scenes::scene_test {
namespace {

constexpr int kFrames = 1000;

RigidTransform pose(const SyntheticScene& scene, int frame) { return world_from_camera(scene.path, frame / scene.fps); }

TEST(CameraPath, StaysFourMetresFromTheTargetAndLooksAtItUpright) {
    const SyntheticScene scene = load_scene("cubes");
    for (int i = 0; i < kFrames; ++i) {
        const RigidTransform world_from_camera = pose(scene, i);
        EXPECT_LT(rotation_defect(world_from_camera), 1e-14);
        const glm::dvec3 target_m(rigid_inverse(world_from_camera) *
                                  glm::dvec4(std::get<OrbitPath>(scene.path).target_m, 1));
        EXPECT_LT(glm::distance(target_m, glm::dvec3(0, 0, 4)), 1e-12);
        EXPECT_EQ(world_from_camera[0].y, 0) << "the camera's x axis must be level";
        EXPECT_GT(world_from_camera[1].y, 0) << "the camera's y axis must point down";
    }
}

TEST(CameraPath, MovesAsAPersonWithACameraDoes) {
    const SyntheticScene scene = load_scene("cubes");
    for (int i = 1; i + 1 < kFrames; ++i) {
        const glm::dvec3 before(pose(scene, i - 1)[3]), now(pose(scene, i)[3]), after(pose(scene, i + 1)[3]);
        EXPECT_LT(glm::distance(before, now) * scene.fps, 1.05) << "m/s";
        EXPECT_LT(glm::length(after - 2.0 * now + before) * scene.fps * scene.fps, 1.5) << "m/s^2";
    }
}

TEST(CameraPath, OscillatesAroundTheScene) {
    const SyntheticScene scene = load_scene("cubes");
    double leftmost = 0, rightmost = 0, lowest = 10, highest = 0;
    for (int i = 0; i < 60 * 30; ++i) {
        const glm::dvec3 center_m(pose(scene, i)[3]);
        leftmost = std::min(leftmost, center_m.x);
        rightmost = std::max(rightmost, center_m.x);
        lowest = std::min(lowest, -center_m.y);
        highest = std::max(highest, -center_m.y);
    }
    EXPECT_LT(leftmost, -3);
    EXPECT_GT(rightmost, 3);
    EXPECT_GT(lowest, 1.5);
    EXPECT_LT(highest, 3.2);
    EXPECT_GT(highest - lowest, 0.8);
}

TEST(SteepestView, OfAnOrbitIsItsHighestOrLowestElevation) {
    OrbitPath orbit{.elevation_rad = 0.6, .elevation_amplitude_rad = 0.3, .elevation_period_s = 8};
    EXPECT_DOUBLE_EQ(steepest_view(orbit).angle_rad, 0.9);
    EXPECT_DOUBLE_EQ(steepest_view(orbit).time_s, 2);
    orbit.elevation_rad = -0.6;
    EXPECT_DOUBLE_EQ(steepest_view(orbit).angle_rad, 0.9);
    EXPECT_DOUBLE_EQ(steepest_view(orbit).time_s, 6);
    orbit.elevation_phase_rad = 1;
    const double time_s = steepest_view(orbit).time_s;
    EXPECT_NEAR(std::asin(world_from_camera(orbit, time_s)[2].y), -0.9, 1e-12);
}

TEST(SteepestView, OfATourIsFoundBetweenItsWaypoints) {
    // Both waypoints look along x; half way the target passes straight below the camera.
    const WaypointPath tour{{{{0, 0, 0}, {1, 1, 0}}, {{0, 0, 0}, {-1, 1, 0}}}, 10};
    EXPECT_DOUBLE_EQ(steepest_view(tour).angle_rad, std::numbers::pi / 2);
    EXPECT_DOUBLE_EQ(steepest_view(tour).time_s, 2.5);
    const WaypointPath level{{{{0, 0, 0}, {1, 0, 1}}, {{0, 0, 0}, {-1, 0, 1}}}, 10};
    EXPECT_EQ(steepest_view(level).angle_rad, 0);
}

TEST(Cubes, HaveEdgesOf40CentimetresAndStandOnTheFloorOrOneAnother) {
    const SyntheticScene scene = load_scene("cubes");
    ASSERT_GT(scene.objects.size(), 5u);
    EXPECT_TRUE(std::holds_alternative<RectangleShape>(scene.objects.front().parts.front().shape));
    for (size_t i = 1; i < scene.objects.size(); ++i) {
        const SceneObject& cube = scene.objects[i];
        EXPECT_EQ(std::get<BoxShape>(cube.parts.front().shape).half_size_m, glm::dvec3(0.2)) << cube.material.name;
        double lowest_m = INFINITY;
        for (const glm::dvec3& p : box_around(cube.parts.front()).corners()) lowest_m = std::min(lowest_m, -p.y);
        const bool stacked = std::abs(lowest_m - 0.4) < 1e-12;
        EXPECT_TRUE(stacked || std::abs(lowest_m) < 1e-12) << cube.material.name << " at " << lowest_m << " m";
        for (size_t j = 1; j < i; ++j)
            EXPECT_LE(overlap_m(cube, scene.objects[j]), 1e-9)
                << cube.material.name << ", " << scene.objects[j].material.name;
    }
}

TEST(Cubes, MaterialsAreAlbedosWithUniqueIds) {
    std::set<uint32_t> ids;
    for (const sensor::Material& m : materials_of(load_scene("cubes"))) {
        EXPECT_TRUE(ids.insert(m.id).second && m.id > 0) << m.name;
        ASSERT_TRUE(m.kd) << m.name;
        for (int c = 0; c < 3; ++c) EXPECT_LE((*m.kd)[c] + m.ks[c], 1) << m.name;
        EXPECT_GT(m.alpha, 0) << m.name;
        EXPECT_LE(m.alpha, 1) << m.name;
    }
}

TEST(SyntheticScene, UnknownNameIsAnErrorThatListsTheKnown) {
    try {
        load_scene("spheres");
        FAIL() << "no error";
    } catch (const Error& error) {
        EXPECT_THAT(error.what(), ::testing::AllOf(::testing::HasSubstr("'spheres'"), ::testing::HasSubstr("cubes")));
    }
}

}  // namespace
}  // namespace patina::scenes::scene_test
