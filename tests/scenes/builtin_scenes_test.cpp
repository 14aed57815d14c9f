// What the scenes in assets/scenes promise.

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenes/description/clearance.h"
#include "scenes/files/scene_file.h"
#include "tests/scenes/part_box.h"

namespace patina::scenes::builtin_scenes_test {
namespace {

constexpr double kContact_m = 1e-3;  // what stands on something touches it up to the rounding of written positions
constexpr std::array kNames{"balls", "bunnies", "cubes", "halls", "office", "print"};

/// Each scene is loaded once.
const SyntheticScene& loaded(const std::string& name) {
    static std::map<std::string, SyntheticScene> scenes;
    const auto found = scenes.find(name);
    return found != scenes.end() ? found->second : scenes.emplace(name, load_scene(name)).first->second;
}

const SceneObject& named(const SyntheticScene& scene, const std::string& name) {
    const auto found = std::find_if(scene.objects.begin(), scene.objects.end(),
                                    [&](const SceneObject& o) { return o.material.name == name; });
    if (found == scene.objects.end()) throw Error("no object '", name, "'");
    return *found;
}

double period_s(const CameraPath& path) {
    const auto* tour = std::get_if<WaypointPath>(&path);
    return tour ? tour->period_s : std::get<OrbitPath>(path).azimuth_period_s;
}

glm::dvec3 largest_kd(const SceneObject& object) {
    if (!object.texture) return *object.material.kd;
    glm::vec3 largest(0);
    for (const glm::vec3& kd : object.texture->kd->pixels()) largest = glm::max(largest, kd);
    return glm::dvec3(largest);
}

/// The greatest speeds along a path that is sampled at the scene's frame rate.
struct Speeds {
    double metres_per_s = 0;
    double degrees_per_s = 0;
};
Speeds speeds(const SyntheticScene& scene, const CameraPath& path) {
    Speeds most;
    RigidTransform before = world_from_camera(path, 0);
    for (int i = 1; i <= period_s(path) * scene.fps; ++i) {
        const RigidTransform now = world_from_camera(path, i / scene.fps);
        const double cosine = glm::clamp(glm::dot(glm::dvec3(before[2]), glm::dvec3(now[2])), -1.0, 1.0);
        most.metres_per_s = std::max(most.metres_per_s, glm::distance(before[3], now[3]) * scene.fps);
        most.degrees_per_s = std::max(most.degrees_per_s, glm::degrees(std::acos(cosine)) * scene.fps);
        before = now;
    }
    return most;
}

class BuiltinScenes : public ::testing::TestWithParam<const char*> {
  protected:
    const SyntheticScene& scene() const { return loaded(GetParam()); }
};

INSTANTIATE_TEST_SUITE_P(All, BuiltinScenes, ::testing::ValuesIn(kNames),
                         [](const auto& p) { return std::string(p.param); });

TEST(BuiltinSceneNames, AreThoseTestedHereAndStepsFromThem) {
    EXPECT_EQ(scene_names(),
              "balls, bunnies, bunnies-all, bunnies-area, bunnies-bounces, bunnies-bumps-15, bunnies-bumps-2, "
              "bunnies-bumps-8, bunnies-glossy, bunnies-noise, bunnies-rough, bunnies-sky, cubes, halls, office, "
              "office-all, office-area, office-bounces, office-noise, office-window, print");
}

TEST(BuiltinSceneFiles, AllLoad) {
    std::istringstream names(scene_names());
    for (std::string name; std::getline(names >> std::ws, name, ',');) {
        EXPECT_EQ(loaded(name).name, name);
        EXPECT_TRUE(loaded(name).recording.render.shadows) << name;
    }
}

TEST(BuiltinSceneFiles, HarderScenesAreOneStepFromTheSceneThatTheyAreNamedAfter) {
    const SyntheticScene &bunnies = loaded("bunnies"), &office = loaded("office");
    EXPECT_TRUE(loaded("bunnies-area").recording.render.area_lights);
    EXPECT_TRUE(loaded("office-area").recording.render.area_lights);
    EXPECT_EQ(loaded("bunnies-bounces").recording.render.bounces, 2u);
    EXPECT_GT(loaded("office-noise").recording.noise.depth_constant_m, 0);
    EXPECT_TRUE(loaded("bunnies-sky").environment && !bunnies.environment);
    EXPECT_EQ(named(loaded("bunnies-glossy"), "teal").material.alpha, 0.08);
    EXPECT_EQ(named(loaded("bunnies-glossy"), "teal").material.ks, named(bunnies, "teal").material.ks);
    const SyntheticScene& window = loaded("office-window");
    EXPECT_EQ(window.objects.size(), office.objects.size());
    EXPECT_EQ(named(window, "window wall").material.id, window.objects.size());
    for (const char* step : {"bunnies-bumps-2", "bunnies-bumps-8", "bunnies-bumps-15", "bunnies-all"}) {
        const auto mesh_of = [](const SyntheticScene& scene) {
            return std::get<MeshShape>(named(scene, "teal").parts[0].shape).mesh;
        };
        EXPECT_GE(mesh_of(loaded(step))->triangles.size(), mesh_of(bunnies)->triangles.size()) << step;
        EXPECT_NE(mesh_of(loaded(step))->positions_m, mesh_of(bunnies)->positions_m) << step;
        EXPECT_EQ(named(loaded(step), "teal").material.alpha, named(bunnies, "teal").material.alpha) << step;
        EXPECT_EQ(world_from_camera(loaded(step).path, 3), world_from_camera(bunnies.path, 3)) << step;
        EXPECT_EQ(loaded(step).name, step);
    }
}

TEST_P(BuiltinScenes, MaterialsAreLikeMeasuredOnes) {
    std::set<std::string> names;
    std::set<uint32_t> ids;
    for (const SceneObject& object : scene().objects) {
        const sensor::Material& m = object.material;
        EXPECT_TRUE(names.insert(m.name).second && ids.insert(m.id).second) << m.name;
        for (int c = 0; c < 3; ++c) {
            EXPECT_LE(largest_kd(object)[c] + m.ks[c], 0.85) << m.name;
            EXPECT_GE(m.ks[c], 0.01) << m.name;  // measured, calibrated: 0.005 to 0.4
            EXPECT_LE(m.ks[c], 0.4) << m.name;
        }
        EXPECT_GE(m.alpha, 0.02) << m.name;
        EXPECT_LE(m.alpha, 0.5) << m.name;  // where the fits to measured ones end
    }
}

TEST_P(BuiltinScenes, LampsAreSpheresOfAHandsBreadthInFreeAir) {
    EXPECT_EQ(scene().lights.size(), scene().name == "halls" ? 8u : 3u);
    const Clearance clearance(scene().objects);
    for (const Light& lamp : scene().lights) {
        EXPECT_GE(lamp.radius_m, 0.05);
        EXPECT_LE(lamp.radius_m, 0.12);
        EXPECT_GE(clearance.at(lamp.position_m), lamp.radius_m);
    }
}

TEST_P(BuiltinScenes, CamerasMoveLikeAPersonAndKeepClear) {
    Clearance clearance(scene().objects);
    for (const Light& lamp : scene().lights) clearance.add(lamp);
    ASSERT_TRUE(scene().lighting);
    for (const CameraPath& path : {scene().path, scene().lighting->path}) {
        EXPECT_LT(speeds(scene(), path).metres_per_s, 1.05);
        EXPECT_LT(speeds(scene(), path).degrees_per_s, 45);
        double nearest_m = INFINITY;
        for (double t = 0; t < period_s(path); t += 0.1)
            nearest_m = std::min(nearest_m, clearance.at(glm::dvec3(world_from_camera(path, t)[3])));
        EXPECT_GT(nearest_m, 0.35);
    }
}

TEST_P(BuiltinScenes, ObjectsNeitherIntersectNorFloat) {
    const std::vector<SceneObject>& objects = scene().objects;
    std::vector<size_t> held;  // what hangs together with the floor, the first object, or a surface of the room
    std::vector<bool> is_held(objects.size());
    const auto hold = [&](size_t i) {
        if (!is_held[i]) held.push_back(i);
        is_held[i] = true;
    };
    std::vector<std::vector<bool>> touch(objects.size(), std::vector<bool>(objects.size()));
    for (size_t i = 0; i < objects.size(); ++i) {
        if (std::holds_alternative<RectangleShape>(objects[i].parts.front().shape)) hold(i);
        for (size_t j = 0; j < i; ++j) {
            const double overlap = overlap_m(objects[i], objects[j]);
            EXPECT_LT(overlap, kContact_m) << objects[i].material.name << ", " << objects[j].material.name;
            touch[i][j] = touch[j][i] = overlap > -kContact_m;
        }
    }
    for (size_t next = 0; next < held.size(); ++next) {
        for (size_t i = 0; i < objects.size(); ++i)
            if (touch[held[next]][i]) hold(i);
    }
    for (size_t i = 0; i < objects.size(); ++i) EXPECT_TRUE(is_held[i]) << objects[i].material.name;
}

TEST(Bunnies, ThreeFiguresOf1Point5MetresStandOnAFloor) {
    const SyntheticScene& scene = loaded("bunnies");
    const std::array expected{"floor", "yellow", "teal", "orange"};
    ASSERT_EQ(scene.objects.size(), expected.size());
    for (size_t i = 0; i < expected.size(); ++i) EXPECT_EQ(scene.objects[i].material.name, expected[i]);
    for (size_t i = 1; i < expected.size(); ++i) {
        double lowest_m = INFINITY, highest_m = -INFINITY;
        for (const glm::dvec3& p : box_around(scene.objects[i].parts.front()).corners()) {
            lowest_m = std::min(lowest_m, -p.y);
            highest_m = std::max(highest_m, -p.y);
        }
        EXPECT_NEAR(lowest_m, 0, 1e-6);
        EXPECT_NEAR(highest_m, 1.5, 1e-6);
    }
}

TEST(Bunnies, DifferInKdKsAndAlphaAndInHowTheyAreTurned) {
    const SyntheticScene& scene = loaded("bunnies");
    for (size_t i = 1; i < 4; ++i) {
        for (size_t j = 1; j < i; ++j) {
            const SceneObject &a = scene.objects[i], &b = scene.objects[j];
            EXPECT_GT(glm::distance(*a.material.kd, *b.material.kd), 0.1);
            EXPECT_GT(std::abs(a.material.ks.g - b.material.ks.g), 0.02);
            EXPECT_GT(std::abs(a.material.alpha - b.material.alpha), 0.05);
            EXPECT_LT(glm::dot(a.parts.front().world_from_part[2], b.parts.front().world_from_part[2]), 0.95);
        }
    }
}

TEST(Bunnies, CameraStaysFourMetresAway) {
    const SyntheticScene& scene = loaded("bunnies");
    const auto& orbit = std::get<OrbitPath>(scene.path);
    EXPECT_EQ(orbit.distance_m, 4);
    EXPECT_GT(orbit.azimuth_amplitude_rad, 1.5);
    EXPECT_GT(orbit.elevation_amplitude_rad, 0.1);
}

TEST(Balls, KsAndAlphaRiseAlongTheTwoAxesOfAGrid) {
    const SyntheticScene& scene = loaded("balls");
    ASSERT_TRUE(scene.objects.front().texture);
    std::set<double> ks, alphas;
    for (size_t i = 1; i < scene.objects.size(); ++i) {
        const SceneObject& ball = scene.objects[i];
        EXPECT_TRUE(std::holds_alternative<SphereShape>(ball.parts.front().shape));
        ks.insert(ball.material.ks.r);
        alphas.insert(ball.material.alpha);
        for (size_t j = 1; j < i; ++j) {
            const SceneObject& other = scene.objects[j];
            const glm::dvec3 way(ball.parts.front().world_from_part[3] - other.parts.front().world_from_part[3]);
            const auto same_sign = [](double a, double b) { return (a > 0) == (b > 0) && (a < 0) == (b < 0); };
            EXPECT_TRUE(same_sign(way.x, ball.material.alpha - other.material.alpha));
            EXPECT_TRUE(same_sign(way.z, ball.material.ks.r - other.material.ks.r));
        }
    }
    EXPECT_EQ(scene.objects.size() - 1, ks.size() * alphas.size());
    EXPECT_GE(std::min(ks.size(), alphas.size()), 5u);
}

TEST(Office, IsAFurnishedRoom) {
    const SyntheticScene& scene = loaded("office");
    EXPECT_GE(scene.objects.size(), 25u);
    const auto count = [&](auto holds) { return std::count_if(scene.objects.begin(), scene.objects.end(), holds); };
    EXPECT_GE(count([](const SceneObject& o) { return o.texture.has_value(); }), 8);
    EXPECT_GE(count([](const SceneObject& o) { return o.material.alpha <= 0.06; }), 5) << "glossy";
    EXPECT_GE(count([](const SceneObject& o) { return o.material.ks.r >= 0.2; }), 4) << "metal";
    EXPECT_GE(count([](const SceneObject& o) { return o.parts.size() > 1; }), 8) << "of several parts";
    EXPECT_GE(count([](const SceneObject& o) { return std::holds_alternative<MeshShape>(o.parts.front().shape); }), 1);
}

TEST(Office, EverythingIsWithinTheClosedRoom) {
    const SyntheticScene& scene = loaded("office");
    for (const SceneObject& object : scene.objects) {
        for (const Part& part : object.parts) {
            for (const glm::dvec3& p : box_around(part).corners()) {
                EXPECT_LE(std::abs(p.x), 3 + kContact_m) << object.material.name;
                EXPECT_LE(std::abs(p.z), 2.5 + kContact_m) << object.material.name;
                EXPECT_GE(-p.y, -kContact_m) << object.material.name;
                EXPECT_LE(-p.y, 2.6 + kContact_m) << object.material.name;
            }
        }
    }
    // Six rectangles of the room's size around its middle leave no gap.
    const std::array sides{"floor", "ceiling", "back wall", "brick wall", "left wall", "right wall"};
    for (const char* side : sides) {
        const PartBox box = box_around(named(scene, side).parts.front());
        const glm::dvec3 outward = glm::round((box.center_m - glm::dvec3(0, -1.3, 0)) / glm::dvec3(3, 1.3, 2.5));
        EXPECT_NEAR(glm::length(outward), 1, 1e-9) << side;
        const glm::dvec3 reach = glm::abs(box.axes[0]) * box.half_size_m.x + glm::abs(box.axes[1]) * box.half_size_m.y;
        const glm::dvec3 expected = glm::dvec3(3, 1.3, 2.5) * (1.0 - glm::abs(outward));
        EXPECT_LT(glm::distance(reach, expected), 1e-9) << side;
    }
}

TEST(Halls, AreSixOfficesRoundAHall) {
    const SyntheticScene &halls = loaded("halls"), &office = loaded("office");
    double floor_m2 = 0;
    size_t rooms = 0, own = 0;
    for (const SceneObject& object : halls.objects) {
        const std::string& name = object.material.name;
        own += name.find(": ") == std::string::npos;
        rooms += name.ends_with(": floor");
        if (name != "floor" && !name.ends_with(": floor")) continue;
        const glm::dvec2 half_m = std::get<RectangleShape>(object.parts.front().shape).half_size_m;
        floor_m2 += 4 * half_m.x * half_m.y;
    }
    EXPECT_EQ(rooms, 6u);
    EXPECT_EQ(halls.objects.size(), own + rooms * (office.objects.size() - 3)) << "without the wall with the door";
    EXPECT_NEAR(floor_m2, 300, 10);
}

TEST(Halls, TheTourGoesIntoEveryRoomAndIntoTheFirstOneTwice) {
    const SyntheticScene& halls = loaded("halls");
    std::string visits;  // a letter for each room that is entered
    char before = '.';
    for (double t = 0; t < period_s(halls.path); t += 0.1) {
        const glm::dvec3 camera(world_from_camera(halls.path, t)[3]);
        const char room =
            std::abs(camera.z) < 3.1 ? '.' : (camera.z < 0 ? "abc" : "def")[static_cast<int>((camera.x + 9.75) / 6.5)];
        if (room != before && room != '.') visits += room;
        before = room;
    }
    EXPECT_EQ(visits, "abcafed");
    EXPECT_EQ(period_s(halls.path) * halls.fps, 5000);
}

TEST(PartBoxes, OverlapIsTheLeastPushThatPartsThem) {
    const auto box = [](glm::dvec3 center, double degrees) {
        return box_around({BoxShape{glm::dvec3(0.5)}, placed(center, {0, 1, 0}, glm::radians(degrees))});
    };
    EXPECT_NEAR(overlap_m(box({0, 0, 0}, 0), box({0.9, 0, 0}, 0)), 0.1, 1e-12);
    EXPECT_NEAR(overlap_m(box({0, 0, 0}, 0), box({1.25, 0, 0}, 0)), -0.25, 1e-12);
    EXPECT_NEAR(overlap_m(box({0, 0, 0}, 0), box({0, -1, 0}, 30)), 0, 1e-12);  // one stands on the other
    EXPECT_NEAR(overlap_m(box({0, 0, 0}, 0), box({1.2, 0, 0}, 45)), 0.5 + std::sqrt(0.5) - 1.2, 1e-12);
}

}  // namespace
}  // namespace patina::scenes::builtin_scenes_test
