#include "scenes/description/vary.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "scenes/description/clearance.h"
#include "scenes/description/draws.h"
#include "scenes/files/scene_file.h"
#include "scenes/render/material_table.h"
#include "tests/scenes/scene_json.h"
#include "tests/sensor/sequences.h"

namespace patina::scenes::vary_test {
namespace {

using sensor::testing::TemporaryFolder;

SyntheticScene small_scene() {
    const TemporaryFolder folder;
    return testing::load(folder / "small.json", testing::small_scene());
}

double total_luminance(const SyntheticScene& scene) {
    double total = 0;
    for (const Light& light : scene.lights) total += glm::dot(light.intensity, {0.2126, 0.7152, 0.0722});
    return total;
}

glm::dvec3 camera_at(const CameraPath& path, double time_s) { return glm::dvec3(world_from_camera(path, time_s)[3]); }

bool same(const SyntheticScene& a, const SyntheticScene& b) {
    for (size_t i = 0; i < a.objects.size(); ++i) {
        const SceneObject &x = a.objects[i], &y = b.objects[i];
        if (x.material.kd != y.material.kd || x.material.ks != y.material.ks || x.material.alpha != y.material.alpha)
            return false;
        if (x.texture && x.texture->kd->pixels() != y.texture->kd->pixels()) return false;
    }
    for (size_t i = 0; i < a.lights.size(); ++i) {
        if (a.lights[i].position_m != b.lights[i].position_m || a.lights[i].intensity != b.lights[i].intensity)
            return false;
    }
    if (a.environment && a.environment->radiance->pixels() != b.environment->radiance->pixels()) return false;
    return camera_at(a.path, 1.5) == camera_at(b.path, 1.5);
}

void expect_valid(const sensor::Material& m, glm::dvec3 kd) {
    for (int c = 0; c < 3; ++c) {
        EXPECT_GE(kd[c], 0) << m.name;
        EXPECT_GE(m.ks[c], 0) << m.name;
        EXPECT_LE(kd[c] + m.ks[c], 1) << m.name;
    }
    EXPECT_GE(m.alpha, 0.02) << m.name;
    EXPECT_LE(m.alpha, 0.5) << m.name;
}

TEST(MaterialTable, IsPlausibleAndSpreadsOverTheMeasuredRange) {
    std::set<std::string> names;
    std::vector<double> kd, ks, alpha;
    for (const TableMaterial& m : material_table()) {
        EXPECT_TRUE(names.insert(m.name).second) << m.name;
        for (int c = 0; c < 3; ++c) EXPECT_LT(m.kd[c] + m.ks[c], 0.95) << m.name;
        kd.push_back((m.kd.x + m.kd.y + m.kd.z) / 3);
        ks.push_back((m.ks.x + m.ks.y + m.ks.z) / 3);
        alpha.push_back(m.alpha);
    }
    EXPECT_GE(names.size(), 40u);
    for (auto* values : {&kd, &ks, &alpha}) std::sort(values->begin(), values->end());
    EXPECT_LT(kd[2], 0.011);
    EXPECT_GT(kd[kd.size() - 3], 0.45);
    EXPECT_LT(ks[1], 0.012);
    EXPECT_GT(ks[ks.size() - 3], 0.2);
    EXPECT_LE(alpha.front(), 0.025);
    EXPECT_EQ(alpha.back(), 0.5);
}

TEST(Draws, AreHashesOfSeedSubjectIndexAndCount) {
    Draws a(7, "light", 2), again(7, "light", 2);
    for (int i = 0; i < 10; ++i) EXPECT_EQ(a.between(0, 1), again.between(0, 1));
    std::set<double> firsts;
    for (Draws draws : {Draws(7, "light", 2), Draws(8, "light", 2), Draws(7, "material", 2), Draws(7, "light", 3)})
        EXPECT_TRUE(firsts.insert(draws.between(0, 1)).second);
}

TEST(Draws, AreEven) {
    Draws draws(1, "mean");
    double sum = 0, squares = 0;
    glm::dvec3 center(0);
    constexpr int kCount = 10000;
    for (int i = 0; i < kCount; ++i) {
        const double value = draws.between(-1, 1);
        sum += value;
        squares += value * value;
        const glm::dvec3 p = draws.in_ball();
        EXPECT_LE(glm::length(p), 1);
        center += p;
    }
    EXPECT_NEAR(sum / kCount, 0, 0.02);  // 3.5 sigma of the mean
    EXPECT_NEAR(squares / kCount, 1.0 / 3, 0.011);
    EXPECT_LT(glm::length(center / double(kCount)), 0.02);
}

TEST(Varied, TheSameSeedGivesTheSameSceneAndAnotherDoesNot) {
    for (const SyntheticScene& scene : {small_scene(), load_scene("cubes")}) {
        EXPECT_TRUE(same(varied(scene, 5), varied(scene, 5)));
        EXPECT_FALSE(same(varied(scene, 5), varied(scene, 6)));
        EXPECT_FALSE(same(varied(scene, 5), scene));
    }
    const SyntheticScene once = load_scene("cubes", {.vary = 5});
    EXPECT_TRUE(same(once, varied(load_scene("cubes"), 5)));
}

TEST(Varied, EveryMaterialChangesAndStaysValid) {
    const SyntheticScene scene = small_scene();
    for (uint64_t seed = 0; seed < 60; ++seed) {
        const SyntheticScene other = varied(scene, seed);
        for (size_t i = 0; i < scene.objects.size(); ++i) {
            const SceneObject &before = scene.objects[i], &after = other.objects[i];
            EXPECT_EQ(after.material.id, before.material.id);
            EXPECT_EQ(after.material.name, before.material.name);
            EXPECT_NE(after.material.ks, before.material.ks);
            EXPECT_NE(after.material.alpha, before.material.alpha);
            glm::dvec3 kd(0);
            if (after.texture) {
                for (const glm::vec3 pixel : after.texture->kd->pixels()) kd = glm::max(kd, glm::dvec3(pixel));
            } else {
                kd = *after.material.kd;
            }
            expect_valid(after.material, kd);
        }
    }
}

TEST(Varied, ATextureKeepsItsPicture) {
    const SyntheticScene scene = small_scene(), other = varied(scene, 3);
    const Image<glm::vec3>&before = *scene.objects[0].texture->kd, &after = *other.objects[0].texture->kd;
    const glm::vec3 tint = after.at(0, 0) / before.at(0, 0);
    for (size_t i = 0; i < before.pixels().size(); ++i)
        ASSERT_LT(glm::distance(after.pixels()[i], tint * before.pixels()[i]), 1e-6f);
    EXPECT_NE(tint.x, tint.y);
}

TEST(Varied, MaterialsOfOneSceneDiffer) {
    const SyntheticScene other = varied(load_scene("cubes"), 11);
    std::set<double> alphas;
    for (const SceneObject& object : other.objects) alphas.insert(object.material.alpha / object.material.ks.x);
    EXPECT_EQ(alphas.size(), other.objects.size());
}

TEST(Varied, LightsMoveAFewStepsAndKeepTheirTotal) {
    const SyntheticScene scene = load_scene("cubes");
    for (uint64_t seed = 0; seed < 60; ++seed) {
        const SyntheticScene other = varied(scene, seed);
        EXPECT_NEAR(total_luminance(other), total_luminance(scene), 1e-9);
        for (size_t i = 0; i < scene.lights.size(); ++i) {
            const double moved_m = glm::distance(other.lights[i].position_m, scene.lights[i].position_m);
            EXPECT_GT(moved_m, 0);
            EXPECT_LT(moved_m, 0.2 * 3.6);
            EXPECT_LT(other.lights[i].position_m.y, -1);
            EXPECT_NE(other.lights[i].intensity, scene.lights[i].intensity);
        }
    }
}

TEST(Varied, PathsStayNearAndNeverSpeedUp) {
    const SyntheticScene scene = load_scene("cubes");
    for (uint64_t seed = 0; seed < 60; ++seed) {
        const CameraPath path = varied(scene, seed).path;
        const auto orbit = std::get<OrbitPath>(path);
        EXPECT_LE(std::abs(orbit.distance_m - 4), 0.8);
        EXPECT_NE(orbit.azimuth_phase_rad, 0);
        EXPECT_LE(steepest_view(path).angle_rad, kSteepestView_rad);
        for (int i = 0; i < 300; ++i) {
            const glm::dvec3 before = camera_at(path, i / 30.0), after = camera_at(path, (i + 1) / 30.0);
            ASSERT_LT(glm::distance(before, after) * scene.fps, 1.2) << "m/s, seed " << seed;
            ASSERT_LT(after.y, -0.5) << "under the floor, seed " << seed;
        }
    }
}

/// A room of 4 m x 2.5 m x 4 m whose lamp hangs 10 cm below the ceiling, and a tour through its corners.
SyntheticScene room() {
    SyntheticScene scene;
    scene.objects = {{{{BoxShape{{2, 1.25, 2}}, placed({0, -1.25, 0}, {0, 1, 0}, 0)}}, {1, "room", glm::dvec3(0.5)}}};
    scene.lights = {{{0, -2.4, 0}, glm::dvec3(5), 0.05}};
    scene.path = WaypointPath{{{{-1.4, -1.5, -1.4}, {0, -1, 0}},
                               {{1.4, -1.5, -1.4}, {0, -1, 0}},
                               {{1.4, -1.5, 1.4}, {0, -1, 0}},
                               {{-1.4, -1.5, 1.4}, {0, -1, 0}}},
                              20};
    return scene;
}

double distance_to_walls(glm::dvec3 p) {
    return std::min({2 - std::abs(p.x), 1.25 - std::abs(p.y + 1.25), 2 - std::abs(p.z)});
}

TEST(Varied, LampsAndCamerasStayInTheirRoom) {
    const SyntheticScene scene = room();
    const auto nearest_m = [](const CameraPath& path) {
        double nearest = INFINITY;
        for (int i = 0; i < 1000; ++i) nearest = std::min(nearest, distance_to_walls(camera_at(path, i * 0.03)));
        return nearest;
    };
    const double before_m = nearest_m(scene.path);
    for (uint64_t seed = 0; seed < 50; ++seed) {
        const SyntheticScene other = varied(scene, seed);
        EXPECT_GE(distance_to_walls(other.lights[0].position_m) - 0.05, 0.025 - 1e-4) << seed;
        EXPECT_GE(nearest_m(other.path), before_m / 2 - 0.01) << seed;
    }
}

TEST(Clearance, IsTheDistanceToTheNearestSurface) {
    const SyntheticScene scene = small_scene();
    const Clearance clearance(scene.objects);
    EXPECT_NEAR(clearance.at({-1, -1, 0}), 0.6, 1e-12) << "above the ball";
    EXPECT_NEAR(clearance.at({-1, -0.2, 0}), 0.2, 1e-12) << "in the ball's centre";
    EXPECT_NEAR(clearance.at({1, -0.7, 0.5}), 0.05, 1e-12) << "inside the table's top";
    EXPECT_NEAR(clearance.at({1, -1.25, 0.5}), 0.5, 1e-12) << "above the table";
    EXPECT_NEAR(clearance.at({0, 3, 0}), 3, 1e-12) << "below the ground";
    EXPECT_NEAR(clearance.at({5, 4, 0}), 5, 1e-12) << "below and beside the ground's edge";
}

TEST(Clearance, AMeshCountsAsItsFilledBox) {
    auto mesh = std::make_shared<TriangleMesh>();
    mesh->positions_m = {{0, 0, 0}, {2, 0, 0}, {2, 2, 2}};
    mesh->triangles = {{0, 1, 2}};
    const std::vector<SceneObject> objects{{{{MeshShape{mesh}, placed({10, 0, 0}, {0, 1, 0}, 0)}}, {}}};
    EXPECT_NEAR(Clearance(objects).at({15, 1, 1}), 3, 1e-12);
    EXPECT_EQ(Clearance(objects).at({10.1, 1.9, 1}), 0);
}

}  // namespace
}  // namespace patina::scenes::vary_test
