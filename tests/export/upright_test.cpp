#include "export/upright.h"

#include <random>

#include <gmock/gmock.h>

namespace patina::upright_test {
namespace {

constexpr glm::dvec3 kUp(0, 1, 0);

/// Adds a grid of triangles with corners a, a + u, a + v, in steps of some 5 cm, each moved by a normal noise.
void add_sheet(Mesh& mesh, glm::dvec3 a, glm::dvec3 u, glm::dvec3 v, std::mt19937& random, double noise_m = 0.001) {
    std::normal_distribution<double> noise;
    const auto columns = static_cast<uint32_t>(glm::length(u) / 0.05) + 1,
               rows = static_cast<uint32_t>(glm::length(v) / 0.05) + 1;
    const auto first = static_cast<uint32_t>(mesh.positions_m.size());
    for (uint32_t y = 0; y <= rows; ++y) {
        for (uint32_t x = 0; x <= columns; ++x)
            mesh.positions_m.emplace_back(a + u * (double{1} * x / columns) + v * (double{1} * y / rows) +
                                          glm::normalize(glm::cross(u, v)) * noise_m * noise(random));
    }
    for (uint32_t y = 0; y < rows; ++y) {
        for (uint32_t x = 0; x < columns; ++x) {
            const uint32_t i = first + y * (columns + 1) + x;
            mesh.triangles.push_back({i, i + 1, i + columns + 1});
            mesh.triangles.push_back({i + 1, i + columns + 2, i + columns + 1});
        }
    }
}

/// A room of 4 x 2.5 x 3 m with a table and a ramp of 15 degrees; y is up, and the floor at -0.7.
Mesh room(std::mt19937& random) {
    constexpr double kFloor = -0.7;
    Mesh mesh;
    add_sheet(mesh, {0, kFloor, 0}, {0, 0, 3}, {4, 0, 0}, random);             // floor
    add_sheet(mesh, {0, kFloor, 0}, {4, 0, 0}, {0, 2.5, 0}, random);           // far wall, seen from +z
    add_sheet(mesh, {0, kFloor, 0}, {0, 2.5, 0}, {0, 0, 3}, random);           // left wall, seen from +x
    add_sheet(mesh, {1, kFloor + 0.75, 1}, {0, 0, 0.8}, {1.6, 0, 0}, random);  // table
    add_sheet(mesh, {3, kFloor, 1}, {0, 0, 1}, {1, std::tan(glm::radians(15.0)), 0}, random);
    return mesh;
}

/// Seen from a point, with the x axis level in a world with y up.
RigidTransform camera(glm::dvec3 from_m, glm::dvec3 at_m) {
    const glm::dvec3 z = glm::normalize(at_m - from_m), x = glm::normalize(glm::cross(-kUp, z)), y = glm::cross(z, x);
    return {glm::dvec4(x, 0), glm::dvec4(y, 0), glm::dvec4(z, 0), glm::dvec4(from_m, 1)};
}

/// A walk along the room that looks at both walls and down a bit.
std::vector<RigidTransform> walk() {
    std::vector<RigidTransform> cameras;
    for (int i = 0; i <= 20; ++i) cameras.push_back(camera({1.5 + 0.1 * i, 0.8 + 0.01 * i, 2.8}, {0.15 * i, 0.1, 0.5}));
    return cameras;
}

glm::dquat random_turn(std::mt19937& random) {
    std::normal_distribution<double> normal;
    return glm::normalize(glm::dquat(normal(random), normal(random), normal(random), normal(random)));
}

struct World {
    SurfaceSurvey survey{};
    UpHints hints{};
    glm::dvec3 up{0}, floor_point_m{0};
};

/// The room in a world that is turned and moved.
World world(std::mt19937& random, glm::dquat turn, glm::dvec3 offset_m) {
    World result;
    Mesh mesh = room(random);
    for (glm::vec3& position : mesh.positions_m) position = glm::vec3(turn * glm::dvec3(position) + offset_m);
    result.survey.add(mesh, {});
    for (const RigidTransform& pose : walk())
        result.hints.cameras.push_back(glm::translate(glm::dmat4(1), offset_m) * glm::mat4_cast(turn) * pose);
    result.up = turn * kUp;
    result.floor_point_m = turn * glm::dvec3(2, -0.7, 1.5) + offset_m;
    return result;
}

double degrees_between(glm::dvec3 a, glm::dvec3 b) {
    return glm::degrees(std::acos(std::clamp(glm::dot(glm::normalize(a), glm::normalize(b)), -1.0, 1.0)));
}

void expect_upright(const World& world, const Upright& upright, double degrees = 3) {
    EXPECT_LT(degrees_between(upright.y_up_from_world * world.up, kUp), degrees);
    const glm::dvec4 floor_m = upright.gltf_from_world() * glm::dvec4(world.floor_point_m, 1);
    EXPECT_NEAR(floor_m.y, 0, 0.03);
    EXPECT_NEAR(upright.height_of(world.floor_point_m), floor_m.y, 1e-9);
}

TEST(Upright, IsFoundByTheFloorInTurnedWorlds) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> place(-5, 5);
    for (int i = 0; i < 20; ++i) {
        SCOPED_TRACE(i);
        const World turned = world(random, random_turn(random), {place(random), place(random), place(random)});
        const Upright upright = find_upright(turned.hints, turned.survey.patches());
        EXPECT_EQ(upright.source, UpSource::kFloor);
        expect_upright(turned, upright, 0.5);
    }
}

TEST(Upright, IsFoundInWorldsWithYUp) {
    std::mt19937 random(8);
    for (int i = 0; i < 5; ++i) {
        SCOPED_TRACE(i);
        const World turned = world(random, glm::angleAxis(0.3 * i, kUp), {0.1 * i, -0.4 * i, 0});
        const Upright upright = find_upright(turned.hints, turned.survey.patches());
        EXPECT_EQ(upright.source, UpSource::kFloor);
        expect_upright(turned, upright, 0.5);
        EXPECT_LT(degrees_between(upright.y_up_from_world * glm::dvec3(1, 0, 0), {1, 0, 0}), 0.5)
            << "it stays as it is";
    }
}

TEST(Upright, IsFoundByATableBelowACameraThatLooksDownAtIt) {
    std::mt19937 random(9);
    for (int i = 0; i < 20; ++i) {
        SCOPED_TRACE(i);
        const glm::dquat turn = random_turn(random);
        Mesh mesh;
        add_sheet(mesh, {-0.5, 0, -0.5}, {0, 0, 1}, {1, 0, 0}, random);
        World table{.up = turn * kUp};
        for (glm::vec3& position : mesh.positions_m) position = glm::vec3(turn * glm::dvec3(position));
        table.survey.add(mesh, {});
        for (int pose = 0; pose < 8; ++pose)
            table.hints.cameras.push_back(glm::mat4_cast(turn) * camera({0.02 * pose, 0.9, 0.9}, glm::dvec3(0)));
        const Upright upright = find_upright(table.hints, table.survey.patches());
        EXPECT_EQ(upright.source, UpSource::kFloor);
        expect_upright(table, upright, 0.5);
    }
}

TEST(Upright, IsNotWhatARolledCameraSays) {
    std::mt19937 random(13);
    World rolled = world(random, random_turn(random), glm::dvec3(0));
    const RigidTransform roll = glm::rotate(RigidTransform(1), glm::radians(15.0), glm::dvec3(0, 0, 1));
    rolled.hints.cameras = {rolled.hints.cameras.front() * roll};
    EXPECT_GT(degrees_between(*mean_up(rolled.hints.cameras), rolled.up), 14);
    const Upright upright = find_upright(rolled.hints, rolled.survey.patches());
    EXPECT_EQ(upright.source, UpSource::kFloor);
    expect_upright(rolled, upright, 0.5);
}

TEST(Upright, WithoutALevelPlaneIsTheCameras) {
    std::mt19937 random(10);
    const glm::dquat turn = random_turn(random);
    World wall{.up = turn * kUp};
    Mesh mesh;
    add_sheet(mesh, {0, 0, 0}, {2, 0, 0}, {0, 2, 0}, random);
    for (glm::vec3& position : mesh.positions_m) position = glm::vec3(turn * glm::dvec3(position));
    wall.survey.add(mesh, {});
    for (const double x : {0.0, 1.0, 2.0})
        wall.hints.cameras.push_back(glm::mat4_cast(turn) * camera({x, 1, 2}, {1, 1, 0}));
    wall.floor_point_m = turn * glm::dvec3(1, 0.02, 0);  // 1 % of the wall are below it
    const Upright upright = find_upright(wall.hints, wall.survey.patches());
    EXPECT_EQ(upright.source, UpSource::kCameras);
    expect_upright(wall, upright);
}

TEST(Upright, TheUserComesBeforeGravityBeforeTheFloor) {
    std::mt19937 random(11);
    World turned = world(random, random_turn(random), glm::dvec3(0));
    turned.hints.gravity = -9.81 * turned.up;
    Upright upright = find_upright(turned.hints, turned.survey.patches());
    EXPECT_EQ(upright.source, UpSource::kGravity);
    expect_upright(turned, upright, 1e-4);
    turned.hints.gravity = -turned.hints.gravity.value();
    turned.hints.up = 3.0 * turned.up;
    upright = find_upright(turned.hints, turned.survey.patches());
    EXPECT_EQ(upright.source, UpSource::kOption);
    expect_upright(turned, upright, 1e-4);
    EXPECT_LT(glm::distance(upright.up(), turned.up), 1e-9);
}

TEST(Upright, OfNothingIsTheFirstCamerasWorld) {
    const Upright upright = find_upright({}, {});
    EXPECT_EQ(upright.source, UpSource::kNothing);
    EXPECT_EQ(upright.y_up_from_world, kYDownToYUp);
    EXPECT_EQ(upright.floor_m, 0);
    EXPECT_STREQ(name_of(upright.source), "nothing");
}

TEST(Upright, ALevelWorldKeepsItsAxes) {
    for (const double sign : {1.0, -1.0}) {
        for (int axis = 0; axis < 3; ++axis) {
            glm::dvec3 up(0);
            up[axis] = sign;
            const glm::dquat turn = y_up_from(up);
            EXPECT_LT(glm::distance(turn * up, kUp), 1e-12);
            const glm::dquat tilted = y_up_from(up + glm::dvec3(0.01, 0.02, -0.01));
            EXPECT_LT(glm::distance(tilted * glm::dvec3(1, 2, 3), turn * glm::dvec3(1, 2, 3)), 0.1) << axis << sign;
            for (int other = 0; other < 3; ++other) {
                const glm::dvec3 turned = turn * glm::dvec3(other == 0, other == 1, other == 2);
                EXPECT_NEAR(std::max({std::abs(turned.x), std::abs(turned.y), std::abs(turned.z)}), 1, 1e-12);
            }
        }
    }
    EXPECT_LT(glm::distance(y_up_from({0, -1, 0}) * glm::dvec3(0, 0, 1), glm::dvec3(0, 0, -1)), 1e-12);
    EXPECT_LT(glm::distance(y_up_from({0, 0, 1}) * glm::dvec3(1, 0, 0), glm::dvec3(1, 0, 0)), 1e-12);
}

TEST(SurfaceSurvey, OfManyTrianglesIsASampleOfAll) {
    std::mt19937 random(12);
    Mesh mesh;
    add_sheet(mesh, glm::dvec3(0), {0, 0, 30}, {20, 0, 0}, random, 0);
    const size_t pieces = SurfaceSurvey::kMostPatches / mesh.triangles.size() + 3;
    SurfaceSurvey survey;
    const std::vector<uint32_t> labels(mesh.positions_m.size(), 5);
    for (size_t i = 0; i < pieces; ++i) survey.add(mesh, labels);
    EXPECT_LE(survey.patches().size(), SurfaceSurvey::kMostPatches);
    EXPECT_GT(survey.patches().size(), SurfaceSurvey::kMostPatches / 3);
    double area_m2 = 0;
    for (const Patch& patch : survey.patches()) {
        area_m2 += double{patch.area_m2.y};
        ASSERT_EQ(patch.label, 5u);
    }
    EXPECT_NEAR(area_m2, 600.0 * static_cast<double>(pieces), 1.0);
}

}  // namespace
}  // namespace patina::upright_test
