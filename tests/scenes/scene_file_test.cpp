#include "scenes/files/scene_file.h"

#include <cmath>
#include <cstdlib>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenes/description/noise.h"
#include "tests/scenes/scene_json.h"
#include "tests/sensor/sequences.h"

namespace patina::scenes::scene_file_test {
namespace {

using nlohmann::json;
using sensor::testing::TemporaryFolder;
using sensor::testing::write_text;
using ::testing::HasSubstr;
using testing::load;
using testing::load_error;
using testing::small_scene;
using ::testing::StartsWith;

glm::dvec3 center_of(const Part& part) { return glm::dvec3(part.world_from_part[3]); }

TEST(SceneFile, ObjectsAreAsWritten) {
    const TemporaryFolder folder;
    const SyntheticScene scene = load(folder / "a.json", small_scene());
    ASSERT_EQ(scene.objects.size(), 3u);
    const SceneObject &ground = scene.objects[0], &table = scene.objects[1], &ball = scene.objects[2];
    EXPECT_EQ(ground.material.name, "ground");
    EXPECT_EQ(ground.material.id, 1u);
    EXPECT_FALSE(ground.material.kd);
    EXPECT_EQ(ground.material.ks, glm::dvec3(0.05, 0.06, 0.07));
    ASSERT_TRUE(ground.texture);
    EXPECT_EQ(ground.texture->repeat, glm::dvec2(0.5, 0.25));
    EXPECT_EQ(ground.texture->kd->extent(), (Extent2D{64, 64}));
    EXPECT_LT(glm::distance(ground.texture->kd->at(8, 8), glm::vec3(0.8f, 0.7f, 0.6f)), 1e-6f);
    EXPECT_LT(glm::distance(ground.texture->kd->at(24, 8), glm::vec3(0.1f)), 1e-6f);
    EXPECT_EQ(std::get<RectangleShape>(ground.parts[0].shape).half_size_m, glm::dvec2(2, 3));

    EXPECT_EQ(table.material.kd, glm::dvec3(0.24, 0.14, 0.07));
    EXPECT_EQ(table.material.ks, glm::dvec3(0.033));
    EXPECT_EQ(table.material.alpha, 0.2);
    EXPECT_EQ(std::get<BoxShape>(table.parts[0].shape).half_size_m, glm::dvec3(0.5, 0.05, 0.3));
    EXPECT_EQ(std::get<CylinderShape>(table.parts[1].shape).radius_m, 0.05);
    EXPECT_EQ(std::get<CylinderShape>(table.parts[1].shape).half_height_m, 0.325);
    EXPECT_EQ(center_of(table.parts[0]), glm::dvec3(1, -0.7, 0.5));
    EXPECT_LT(glm::distance(glm::dvec3(table.parts[0].world_from_part[0]), glm::dvec3(0, 0, -1)), 1e-15);

    EXPECT_EQ(ball.material.id, 3u);
    EXPECT_EQ(ball.material.kd, glm::dvec3(0.5));
    EXPECT_EQ(std::get<SphereShape>(ball.parts[0].shape).radius_m, 0.2);
}

TEST(SceneFile, AnOffsetMovesATexturesTopLeftCorner) {
    const TemporaryFolder folder;
    nlohmann::json scene = small_scene();
    const auto picture = [&] { return *load(folder / "a.json", scene).objects[0].texture->kd; };
    const Image<glm::vec3> plain = picture();
    scene["textures"]["tiles"]["offset"] = {0.0625, -0.03125};  // of repeats of 0.5 and 0.25: 8 texels right, 8 up
    const Image<glm::vec3> moved = picture();
    for (uint32_t y = 0; y < 64; ++y)
        for (uint32_t x = 0; x < 64; ++x) ASSERT_EQ(moved.at((x + 8) % 64, (y + 56) % 64), plain.at(x, y));
    EXPECT_NE(moved.at(4, 4), plain.at(4, 4));
}

TEST(SceneFile, TheFirstRotationIsTheOutermost) {
    const TemporaryFolder folder;
    json scene = small_scene();
    scene["objects"][2]["rotations"] =
        json::parse(R"([{"axis": [0, 0, 2], "degrees": 90}, {"axis": [1, 0, 0], "degrees": 90}])");
    const RigidTransform world_from_ball = load(folder / "a.json", scene).objects[2].parts[0].world_from_part;
    // y turns about x to z, which the turn about z leaves.
    EXPECT_LT(glm::distance(world_from_ball * glm::dvec4(0, 1, 0, 0), glm::dvec4(0, 0, 1, 0)), 1e-15);
}

TEST(SceneFile, LightsCamerasAndRecordingAreAsWritten) {
    const TemporaryFolder folder;
    const SyntheticScene scene = load(folder / "a.json", small_scene());
    EXPECT_EQ(scene.name, "small");
    EXPECT_EQ(scene.fps, 25);
    EXPECT_EQ(scene.camera, (Intrinsics{{64, 48}, 60, 61, 31.5, 23.5, {}}));
    ASSERT_TRUE(scene.color_camera);
    EXPECT_EQ(scene.color_camera->camera.extent, (Extent2D{96, 54}));
    EXPECT_EQ(scene.color_camera->color_from_depth[3], glm::dvec4(0.05, 0, 0, 1));
    EXPECT_EQ(scene.metres_per_unit, 0.0005);
    EXPECT_EQ(scene.max_metres, 6);
    ASSERT_EQ(scene.lights.size(), 2u);
    EXPECT_EQ(scene.lights[0].position_m, glm::dvec3(0, -2, -1));
    EXPECT_EQ(scene.lights[0].intensity, glm::dvec3(5, 4, 3));
    EXPECT_EQ(scene.lights[0].radius_m, 0.06);
    EXPECT_EQ(scene.lights[1].intensity, glm::dvec3(2));
    EXPECT_EQ(scene.lights[1].radius_m, 0);
    EXPECT_EQ(scene.environment->radiance->extent(), (Extent2D{32, 16}));
    EXPECT_LT(glm::distance(scene.environment->radiance->at(5, 5), glm::vec3(0.2f, 0.4f, 0.6f)), 1e-6f);
    EXPECT_EQ(scene.lighting->frames, 20u);
    EXPECT_EQ(std::get<WaypointPath>(scene.lighting->path).waypoints[1].position_m, glm::dvec3(1, -1.5, -1));
    EXPECT_EQ(std::get<WaypointPath>(scene.lighting->path).period_s, 20);

    const Recording& recording = scene.recording;
    EXPECT_FALSE(recording.render.shadows);
    EXPECT_TRUE(recording.render.area_lights);
    EXPECT_EQ(recording.render.bounces, 2u);
    EXPECT_EQ(recording.render.samples, 16u);
    EXPECT_EQ(recording.render.seed, 7u);
    EXPECT_EQ(recording.seed, 7u);
    EXPECT_TRUE(recording.exr);
    EXPECT_EQ(recording.noise.depth_quadratic_per_m, 0.0019);
    EXPECT_EQ(recording.noise.depth_offset_m, 0.4);
    EXPECT_EQ(recording.noise.pose_translation_m, 0.002);
    EXPECT_EQ(recording.noise.pose_rotation_rad, std::numbers::pi);
}

TEST(SceneFile, OrbitIsInDegreesAndHasPhases) {
    const TemporaryFolder folder;
    const auto orbit = std::get<OrbitPath>(load(folder / "a.json", small_scene()).path);
    EXPECT_DOUBLE_EQ(orbit.azimuth_rad, std::numbers::pi / 18);
    EXPECT_EQ(orbit.azimuth_amplitude_rad, 0);
    EXPECT_DOUBLE_EQ(orbit.elevation_amplitude_rad, std::numbers::pi / 18);
    EXPECT_EQ(orbit.elevation_period_s, 9);
    // A phase of 90 degrees starts at the top.
    EXPECT_NEAR(-world_from_camera(orbit, 0)[3].y, 0.2 + 3 * std::sin(40 * std::numbers::pi / 180), 1e-12);
}

TEST(SceneFile, WhatIsLeftOutHasDefaults) {
    const TemporaryFolder folder;
    json scene = small_scene();
    for (const char* key :
         {"name", "fps", "camera", "color_camera", "depth", "lights", "environment", "lighting", "recording"})
        scene.erase(key);
    const SyntheticScene got = load(folder / "plain.json", scene), expected;
    EXPECT_EQ(got.name, "plain");
    EXPECT_EQ(got.fps, expected.fps);
    EXPECT_EQ(got.camera, expected.camera);
    EXPECT_FALSE(got.color_camera || got.environment || got.lighting);
    EXPECT_TRUE(got.lights.empty());
    EXPECT_EQ(got.max_metres, 8);
    EXPECT_TRUE(got.recording.render.shadows);
    EXPECT_EQ(got.recording.noise.depth_constant_m, 0);
}

TEST(SceneFile, NoiseIsAPresetOrNumbers) {
    const TemporaryFolder folder;
    json scene = small_scene();
    scene["recording"]["noise"] = {{"depth_constant_m", 0.001}, {"flying_pixels", 0.25}, {"color_shot", 1e-4}};
    const SensorNoise noise = load(folder / "a.json", scene).recording.noise;
    EXPECT_EQ(noise.depth_constant_m, 0.001);
    EXPECT_EQ(noise.depth_quadratic_per_m, 0);
    EXPECT_EQ(noise.flying_pixels, 0.25);
    EXPECT_EQ(noise.color_shot, 1e-4);
    EXPECT_EQ(noise_preset("kinect2").depth_quadratic_per_m, 0.00025);
    EXPECT_EQ(noise_preset_names(), "kinect1, kinect2, none");
}

TEST(SceneFile, BuiltInScenesAreThoseOfTheAssetsFolder) {
    const TemporaryFolder folder;
    std::filesystem::create_directories(folder / "scenes");
    write_text(folder / "scenes/b.json", small_scene().dump());
    write_text(folder / "scenes/a.json", small_scene().dump());
    write_text(folder / "scenes/a.png", "");
    ::setenv("PATINA_ASSETS", (folder / "").c_str(), 1);
    EXPECT_EQ(scene_names(), "a, b");
    EXPECT_EQ(load_scene("b").objects.size(), 3u);
    ::unsetenv("PATINA_ASSETS");
    EXPECT_THAT(scene_names(), HasSubstr("cubes"));
}

TEST(SceneFile, TheDocumentsExampleLoads) {
    const std::string document = sensor::testing::read_text(PATINA_SOURCE_DIR "/docs/guide/scenes.md");
    const size_t begin = document.find("```json\n") + 8;
    const TemporaryFolder folder;
    write_text(folder / "example.json", document.substr(begin, document.find("```", begin) - begin));
    const SyntheticScene scene = load_scene((folder / "example.json").string());
    EXPECT_EQ(scene.objects.size(), 3u);
    EXPECT_EQ(scene.lights.size(), 2u);
}

/// `value` put at the JSON pointer `place`; null takes away what is there.
struct SceneFault {
    const char* place;
    json value;
    const char* message;
};

void PrintTo(const SceneFault& fault, std::ostream* out) { *out << fault.place << " = " << fault.value; }

class SceneFaults : public ::testing::TestWithParam<SceneFault> {};

TEST_P(SceneFaults, AreNamedWithFilePathAndValue) {
    const TemporaryFolder folder;
    const json::json_pointer place(GetParam().place);
    json scene = small_scene();
    if (GetParam().value.is_null()) {
        scene[place.parent_pointer()].erase(place.back());
    } else {
        scene[place] = GetParam().value;
    }
    const std::filesystem::path file = folder / "bad.json";
    EXPECT_THAT(load_error(file, scene.dump()), StartsWith(file.string() + ": " + GetParam().message));
}

INSTANTIATE_TEST_SUITE_P(
    SyntheticScene, SceneFaults,
    ::testing::Values(SceneFault{"/ligths", 1,
                                 "ligths is 1, an unknown key; known are: name, base, without, fps, camera, "},
                      SceneFault{"/objects", {}, "objects is missing"},
                      SceneFault{"/objects", json::array(), "objects is [], must hold at least one object"},
                      SceneFault{"/fps", 0, "fps is 0, must be positive"}, SceneFault{"/path", {}, "path is missing"},
                      SceneFault{"/name", 3, "name is 3, must be a string"}));

INSTANTIATE_TEST_SUITE_P(
    Object, SceneFaults,
    ::testing::Values(
        SceneFault{"/objects/1/colour", "red", R"(objects[1].colour is "red", an unknown key; known are: name, mat)"},
        SceneFault{"/objects/1/name", "ground",
                   R"(objects[1].name is "ground", which is the name of another object, at )"},
        SceneFault{"/objects/1/name", {}, "objects[1].name is missing"},
        SceneFault{"/objects/1/parts", json::array(), "objects[1].parts is [], must hold at least one part"},
        SceneFault{
            "/objects/1/parts/0/box/size", {1, -2, 1}, "objects[1].parts[0].box.size[1] is -2, must be positive"},
        SceneFault{"/objects/1/parts/0/box/size", {1, 0, 1}, "objects[1].parts[0].box.size[1] is 0, must be positive"},
        SceneFault{"/objects/1/parts/0/box/size", {1, 2}, "objects[1].parts[0].box.size is [1,2], must be an array of"},
        SceneFault{"/objects/1/parts/0/box/size", 1, "objects[1].parts[0].box.size is 1, must be an array of 3"},
        SceneFault{"/objects/1/parts/0/box/size/2", "NaN",
                   R"(objects[1].parts[0].box.size[2] is "NaN", must be a num)"},
        SceneFault{"/objects/1/parts/0/sphere", {{"radius", 1}}, "objects[1].parts[0] is {"},
        SceneFault{"/objects/1/parts/0/cone", 1, "objects[1].parts[0].cone is 1, an unknown key; known are: rectangle"},
        SceneFault{"/objects/1/parts/1/cylinder/radius", -1,
                   "objects[1].parts[1].cylinder.radius is -1, must be positive"},
        SceneFault{"/objects/2/parts/0/sphere/radius", {}, "objects[2].parts[0].sphere.radius is missing"},
        SceneFault{"/objects/1/position", {1, 2, 1e300}, "objects[1].position[2] is 1e+300, must be from -1e+06 to"},
        SceneFault{
            "/objects/1/rotations/0/axis", {0, 0, 0}, "objects[1].rotations[0].axis is [0,0,0], must not be zero"},
        SceneFault{"/objects/1/parts/0/mesh", {{"file", "a.obj"}}, "objects[1].parts[0] is {"},
        SceneFault{"/objects/2/parts/0", {{"mesh", {{"file", "no.obj"}}}}, R"(objects[2].parts[0].mesh.file: )"},
        SceneFault{"/objects/2/parts/0",
                   {{"mesh", {{"file", "a.obj"}, {"height", 0}}}},
                   "objects[2].parts[0].mesh.height is 0, must be positive"},
        SceneFault{"/objects/2/parts/0",
                   {{"mesh", {{"file", "a.obj"}, {"height", 1}, {"scale", 2}}}},
                   "objects[2].parts[0].mesh.scale is 2, which is of no use beside a height"},
        SceneFault{"/objects/2/parts/0",
                   {{"mesh", {{"file", "a.obj"}, {"up", "x"}}}},
                   R"(objects[2].parts[0].mesh.up is "x", must be one of -y, y, z)"}));

INSTANTIATE_TEST_SUITE_P(
    Material, SceneFaults,
    ::testing::Values(
        SceneFault{"/objects/2/material/alpha", 0, "objects[2].material.alpha is 0, must be above 0 and at most 1"},
        SceneFault{"/objects/2/material/alpha", 1.5, "objects[2].material.alpha is 1.5, must be above 0 and at most 1"},
        SceneFault{"/objects/2/material/kd", {0.1, 1.2, 0}, "objects[2].material.kd[1] is 1.2, must be from 0 to 1"},
        SceneFault{"/objects/2/material/ks", -0.1, "objects[2].material.ks is -0.1, must be from 0 to 1"},
        SceneFault{"/objects/2/material/ks", 0.6,
                   "objects[2].material: kd + ks is 0.5 + 0.6 in red, must be at most 1"},
        SceneFault{"/objects/2/material/kd", {}, "objects[2].material.kd is missing"},
        SceneFault{"/materials/oak/ks", {0.1, 0.9, 0.1}, "materials.oak: kd + ks is 0.14 + 0.9 in green"},
        SceneFault{"/materials/floor/ks", 0.4, "materials.floor: kd + ks is 0.8 + 0.4 in red"},
        SceneFault{"/materials/oak/gloss", 1, "materials.oak.gloss is 1, an unknown key; known are: kd, ks, alpha"},
        SceneFault{"/objects/1/material", "pine",
                   R"(objects[1].material is "pine", must name one of the scene's materials: floor, oak)"},
        SceneFault{"/objects/2/material/kd", "carpet",
                   R"(objects[2].material.kd is "carpet", must name one of the scene's textures: tiles)"},
        SceneFault{"/textures/tiles/repeat/0", 0, "textures.tiles.repeat[0] is 0, must be positive"},
        SceneFault{"/textures/tiles/checker/colors/0/0", 2, "textures.tiles.checker.colors[0][0] is 2, must be from"},
        SceneFault{"/textures/tiles/checker/count/0", 1000,
                   "textures.tiles.checker: the pattern 'checker' has a count"},
        SceneFault{"/textures/tiles/marbel", 1, "textures.tiles.marbel is 1, an unknown key; known are: checker, "},
        SceneFault{"/textures/tiles", {{"file", "no.png"}}, "textures.tiles.file: "},
        SceneFault{"/textures/tiles", {{"file", ""}}, R"(textures.tiles.file is "", must name a file)"}));

INSTANTIATE_TEST_SUITE_P(
    Light, SceneFaults,
    ::testing::Values(SceneFault{"/lights/1/intensity", -2, "lights[1].intensity is -2, must be from 0 to"},
                      SceneFault{"/lights/0/intensity/1", -4, "lights[0].intensity[1] is -4, must be from 0 to"},
                      SceneFault{"/lights/0/radius", -0.1, "lights[0].radius is -0.1, must be from 0 to"},
                      SceneFault{"/lights/0/position", {}, "lights[0].position is missing"},
                      SceneFault{"/lights/0/axis", {0, 0, 0}, "lights[0].axis is [0,0,0], must not be zero"},
                      SceneFault{"/lights/0/power", 60,
                                 "lights[0].power is 60, an unknown key; known are: position, intensity, radi"},
                      SceneFault{"/environment", {{"file", "no.hdr"}}, "environment.file: "},
                      SceneFault{"/environment/sky", json::object(), "environment is {"},
                      SceneFault{"/environment/scale", -1, "environment.scale is -1, must be from 0 to"},
                      SceneFault{"/environment/uniform/radiance/1", -1,
                                 "environment.uniform.radiance[1] is -1, must be from 0 to"}));

INSTANTIATE_TEST_SUITE_P(
    Camera, SceneFaults,
    ::testing::Values(
        SceneFault{"/camera/fx", -60, "camera.fx is -60, must be positive"},
        SceneFault{"/camera/width", 1.5, "camera.width is 1.5, must be a positive whole number"},
        SceneFault{"/camera/height", 100000, "camera.height is 100000, must be at most 16384"},
        SceneFault{"/camera/k1", 0.1, "camera.k1 is 0.1, an unknown key; known are: width, "},
        SceneFault{"/color_camera/color_from_depth/0", 2, "color_camera.color_from_depth: "},
        SceneFault{"/depth/max_metres", 40, "depth.max_metres is 40, but 65535 units of 0.0005 m reach 32.7675 m"},
        SceneFault{"/path/tour", json::object(), "path is {"},
        SceneFault{"/path/orbit/distance", 0, "path.orbit.distance is 0, must be positive"},
        SceneFault{"/path/orbit/elevation_degrees/mean", 85,
                   "path.orbit looks 95 degrees up or down after 0 s, must st"},
        SceneFault{"/path/orbit/elevation_degrees", -90, "path.orbit looks 90 degrees up or down after "},
        SceneFault{"/path/orbit/elevation_degrees/period_s", 0,
                   "path.orbit.elevation_degrees.period_s is 0, must be po"},
        SceneFault{"/lighting/path/tour/waypoints/0/target", {0, 1, -1.5}, "lighting.path.tour looks 90 degrees up or"},
        SceneFault{"/lighting/path/tour/waypoints/0/target", {0, -1.5, -1.5}, "lighting.path.tour looks 90 degrees up"},
        SceneFault{"/lighting/path/tour/waypoints", json::parse(R"([{"position": [0, 0, 0], "target": [1, 0, 0]}])"),
                   "lighting.path.tour.waypoints is ["},
        SceneFault{"/lighting/frames", 0, "lighting.frames is 0, must be a positive whole number"}));

INSTANTIATE_TEST_SUITE_P(
    Recording, SceneFaults,
    ::testing::Values(
        SceneFault{"/recording/shadows", 1, "recording.shadows is 1, must be true or false"},
        SceneFault{"/recording/bounces", -1, "recording.bounces is -1, must be a whole number from 0 to 64"},
        SceneFault{"/recording/samples", 0, "recording.samples is 0, must be a positive whole number"},
        SceneFault{"/recording/seed", 1.5, "recording.seed is 1.5, must be a whole number from 0 to"},
        SceneFault{"/recording/noise", "kinect3",
                   "recording.noise: there is no noise preset 'kinect3'; there is: kinect1, kinect2, none"},
        SceneFault{
            "/recording/noise", {{"flying_pixels", 2}}, "recording.noise.flying_pixels is 2, must be from 0 to 1"},
        SceneFault{
            "/recording/noise", {{"sigma", 2}}, "recording.noise.sigma is 2, an unknown key; known are: depth_c"},
        SceneFault{"/recording/pose_noise/translation", -1, "recording.pose_noise.translation is -1, must be from 0"}));

TEST(SceneFile, ElementsOfAWrongLengthAreNamed) {
    const TemporaryFolder folder;
    json scene = small_scene();
    scene["lighting"]["path"]["tour"]["waypoints"].erase(2);
    scene["lighting"]["path"]["tour"]["waypoints"].erase(1);
    EXPECT_THAT(load_error(folder / "a.json", scene.dump()),
                ::testing::EndsWith(", must hold at least 2 waypoints, not 1"));
}

TEST(SceneFile, MoreObjectsThanLabelsAreAnError) {
    const TemporaryFolder folder;
    json scene = small_scene();
    scene["objects"] = std::vector<json>(65536, json::object());
    EXPECT_THAT(load_error(folder / "a.json", scene.dump()),
                HasSubstr(": objects holds 65536 objects, but label images tell apart 65535"));
}

class IncludedScenes : public ::testing::Test {
  protected:
    /// The small scene, with two places of another like it, less its table.
    json including() {
        json other = small_scene();
        other["name"] = "part";
        other["lights"] = {{{"position", {0, -2, 1}}, {"intensity", 3}},
                           {{"position", {0, -2, 2}}, {"intensity", 4}, {"axis", {3, 4, 0}}}};
        write_text(folder_ / "other.json", other.dump());
        json scene = small_scene();
        scene["lights"] = {{{"position", {9, 9, 9}}, {"intensity", 1}}};
        scene["include"] = {{{"scene", "other.json"},
                             {"without", {"table"}},
                             {"lights", {1}},
                             {"places",
                              {{{"name", "left"}, {"position", {-10, 0, 0}}},
                               {{"name", "right"},
                                {"position", {10, 0, 0}},
                                {"rotations", {{{"axis", {0, 1, 0}}, {"degrees", 180}}}}}}}}};
        return scene;
    }

    std::string error_of(const json& scene) { return load_error(folder_ / "a.json", scene.dump()); }

    const TemporaryFolder folder_;
};

TEST_F(IncludedScenes, AreCopiedToTheirPlaces) {
    const SyntheticScene scene = load(folder_ / "a.json", including());
    std::vector<std::string> names;
    for (const SceneObject& object : scene.objects) {
        EXPECT_EQ(object.material.id, names.size() + 1);
        names.push_back(object.material.name);
    }
    EXPECT_EQ(names, (std::vector<std::string>{"ground", "table", "ball", "left: ground", "left: ball", "right: ground",
                                               "right: ball"}));
    const glm::dvec3 ball = center_of(scene.objects[2].parts[0]);
    EXPECT_LT(glm::distance(center_of(scene.objects[4].parts[0]), ball + glm::dvec3(-10, 0, 0)), 1e-12);
    EXPECT_LT(glm::distance(center_of(scene.objects[6].parts[0]), glm::dvec3(10 - ball.x, ball.y, -ball.z)), 1e-12);
    EXPECT_EQ(scene.objects[6].material.kd, scene.objects[2].material.kd);
    ASSERT_EQ(scene.lights.size(), 3u);
    EXPECT_EQ(scene.lights[0].position_m, glm::dvec3(9));
    EXPECT_LT(glm::distance(scene.lights[2].position_m, glm::dvec3(10, -2, -2)), 1e-12);
    EXPECT_EQ(scene.lights[2].intensity, glm::dvec3(4));
    EXPECT_EQ(scene.lights[0].axis, glm::dvec3(0));
    EXPECT_LT(glm::distance(scene.lights[1].axis, glm::dvec3(0.6, 0.8, 0)), 1e-12);
    EXPECT_LT(glm::distance(scene.lights[2].axis, glm::dvec3(-0.6, 0.8, 0)), 1e-12);
}

TEST_F(IncludedScenes, WhatTheyDoNotHaveIsNamed) {
    const auto error_with = [&](const char* key, const json& value) {
        json scene = including();
        scene["include"][0][key] = value;
        return error_of(scene);
    };
    EXPECT_THAT(error_with("scene", "none.json"), HasSubstr("include[0].scene: "));
    EXPECT_THAT(error_with("without", {"sofa"}),
                HasSubstr(R"(include[0].without[0] is "sofa", which is no object of part)"));
    EXPECT_THAT(error_with("lights", {2}), HasSubstr("include[0].lights[0] is 2, but part has 2 lamps"));
    EXPECT_THAT(error_with("lights", {-1}), HasSubstr("include[0].lights[0] is -1, must be a whole number"));
    EXPECT_THAT(error_with("places", {{{"name", "a"}}, {{"name", "a"}}}),
                HasSubstr(R"(include[0].places[1].name is "a", which is the name of another place)"));
    EXPECT_THAT(error_with("scale", 2), HasSubstr("include[0].scale is 2, an unknown key"));
    write_text(folder_ / "nested.json", including().dump());
    EXPECT_THAT(error_with("scene", "nested.json"), HasSubstr("but this scene is included itself"));
}

class ChangedScenes : public ::testing::Test {
  protected:
    ChangedScenes() { write_text(folder_ / "base.json", small_scene().dump()); }

    std::string error_of(const json& scene) const { return load_error(folder_ / "a.json", scene.dump()); }

    const TemporaryFolder folder_;
};

TEST_F(ChangedScenes, HaveWhatTheirBaseHasButForWhatTheyChange) {
    const SyntheticScene base = load(folder_ / "b.json", small_scene());
    const SyntheticScene changed = load(folder_ / "a.json", {{"base", "base.json"}, {"recording", {{"bounces", 3}}}});
    EXPECT_EQ(changed.name, "a") << "a name is not inherited";
    EXPECT_EQ(changed.recording.render.bounces, 3u);
    EXPECT_EQ(changed.recording.render.shadows, base.recording.render.shadows);
    ASSERT_EQ(changed.objects.size(), base.objects.size());
    EXPECT_EQ(changed.objects[0].material.name, base.objects[0].material.name);
    EXPECT_EQ(changed.lights.size(), base.lights.size());
}

TEST_F(ChangedScenes, TakeObjectsOutAndAddTheirOwn) {
    const SyntheticScene base = load(folder_ / "b.json", small_scene());
    const std::string first = base.objects[0].material.name;
    const json ball = {{"name", "new ball"},
                       {"material", {{"kd", 0.5}, {"ks", 0.05}, {"alpha", 0.1}}},
                       {"parts", {{{"sphere", {{"radius", 0.1}}}}}}};
    const SyntheticScene changed =
        load(folder_ / "a.json", {{"base", "base.json"}, {"without", {first}}, {"objects", {ball}}});
    ASSERT_EQ(changed.objects.size(), base.objects.size());
    EXPECT_EQ(changed.objects.back().material.name, "new ball");
    for (size_t i = 0; i < changed.objects.size(); ++i) {
        EXPECT_EQ(changed.objects[i].material.id, i + 1);
        EXPECT_NE(changed.objects[i].material.name, first);
    }
}

TEST_F(ChangedScenes, WhatIsWrongIsNamed) {
    EXPECT_THAT(error_of({{"base", "none.json"}}), HasSubstr("a.json: base: "));
    EXPECT_THAT(error_of({{"base", "../base.json"}}), HasSubstr("base is \"../base.json\", must be a file beside it"));
    write_text(folder_ / "second.json", R"({"base": "base.json"})");
    EXPECT_THAT(error_of({{"base", "second.json"}}), HasSubstr("which has a base itself"));
    EXPECT_THAT(error_of({{"base", "base.json"}, {"without", {"sofa"}}}),
                HasSubstr(R"(without[0] is "sofa", which is no object of a)"));
    EXPECT_THAT(error_of({{"base", "base.json"}, {"bumps", {{"depth", -1}, {"size", 0.1}}}}),
                HasSubstr("a.json: bumps.depth is -1, must be"));
}

TEST(SceneFile, WhatIsNoJsonIsNamedWithItsLine) {
    const TemporaryFolder folder;
    const std::string file = (folder / "a.json").string();
    EXPECT_THAT(load_error(file, "{\"fps\": 30,\n \"lights\": [NaN]}"),
                StartsWith(file + " is not valid JSON: parse error at line 2, column 13: "));
    EXPECT_THAT(load_error(file, ""), StartsWith(file + " is not valid JSON: parse error at line 1, column 1: "));
    EXPECT_EQ(load_error(file, R"({"lights": [{}, {"position": [0, 1, 1e999]}]})"),
              file + " is not valid JSON: lights[1].position[2]: number overflow parsing '1e999'");
    EXPECT_EQ(load_error(file, R"({"lights": [{}, {"radius": 1, "radius": 2}]})"),
              file + ": lights[1].radius is there twice");
    EXPECT_THAT(load_error(file, R"({"objects": [{"name": null}]})"),
                StartsWith(file + ": objects[0].material is mis"));
}

TEST(SceneFile, AFolderOrAMissingFileIsAnError) {
    const TemporaryFolder folder;
    EXPECT_THROW(load_scene((folder / "").string()), Error);
    EXPECT_THROW(load_scene((folder / "missing.json").string()), Error);
}

TEST(SceneFile, AnEnvironmentThatIsNoHdrFileIsNamed) {
    const TemporaryFolder folder;
    write_text(folder / "sky.png", "no picture");
    json scene = small_scene();
    scene["environment"] = {{"file", "sky.png"}};
    const std::filesystem::path file = folder / "a.json";
    EXPECT_THAT(load_error(file, scene.dump()),
                StartsWith(file.string() + ": environment.file: " + (folder / "sky.png").string()));
}

}  // namespace
}  // namespace patina::scenes::scene_file_test
