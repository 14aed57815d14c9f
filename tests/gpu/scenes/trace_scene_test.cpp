#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "scenes/files/scene_file.h"
#include "tests/gpu/scenes/trace_rig.h"

namespace patina::trace_scene_test {
namespace {

using scenes::RenderSettings;
using scenes::SyntheticScene;

using TraceSceneTest = TraceTest;

/// A rectangle, a turned box and two spheres, so that every kind hides and shadows every other.
SyntheticScene mixed_scene() {
    SyntheticScene scene;
    scene.name = "mixed";
    const sensor::Material gloss{1, "gloss", glm::dvec3(0.3, 0.2, 0.1), glm::dvec3(0.1, 0.2, 0.3), 0.15};
    const auto with_id = [&](uint32_t id) { return sensor::Material{id, "", gloss.kd, gloss.ks, gloss.alpha}; };
    scene.objects = {
        {{{scenes::SphereShape{0.5}, scenes::placed({-0.6, -0.5, 0.2}, {0, 1, 0}, 0)}}, with_id(7)},
        {{{scenes::BoxShape{{0.3, 0.2, 0.4}}, scenes::placed({0.5, -0.6, -0.3}, {1, 2, 3}, 0.9)}}, with_id(65535)},
        {{{scenes::RectangleShape{{1.5, 1.0}}, scenes::placed({0, 0, 0}, {1, 0, 0}, 1.4)}}, gloss},
        {{{scenes::SphereShape{0.2}, scenes::placed({0.2, -0.3, -0.9}, {0, 1, 0}, 0)}}, with_id(3)},
    };
    scene.lights = {{{1.5, -2.5, -2.0}, {4, 5, 6}}, {{-2.0, -1.5, -1.0}, {3, 3, 3}, 0, {0.8, 0.6, 0}}};
    return scene;
}

/// Looks at the mixed scene from the front and above.
RigidTransform above_front() { return scenes::placed({0.05, -1.6, -3}, {1, 0, 0}, -0.4); }

TEST_F(TraceSceneTest, MatchesTheReferenceOnCubes) {
    SyntheticScene scene = scenes::load_scene("cubes");
    // Lamps have tests of their own: rounding at their distance is a larger part of their size.
    for (Light& light : scene.lights) light.radius_m = 0;
    for (const Extent2D extent : {Extent2D{1, 1}, {8, 8}, {13, 7}, {32, 4}, {65, 33}, {512, 424}}) {
        for (const double time_s : {0.0, 7.3, 21.0}) {
            SCOPED_TRACE(text(extent, " at ", time_s, " s"));
            const RigidTransform pose = world_from_camera(scene.path, time_s);
            const Traced got = trace(scene, camera_of(extent), pose);
            const auto expected = reference::trace_scene(scene, camera_of(extent), pose);
            // Rays that pass an edge closer than fp32 can tell: none or few.
            EXPECT_LE(compare(got, expected, scene).surface, extent.area() / 10000);
        }
    }
}

TEST_F(TraceSceneTest, ShadowsDarkenAndFallWhereTheReferenceHasThem) {
    const SyntheticScene scene = mixed_scene();
    const Intrinsics camera = camera_of({301, 203});
    expect_reference(scene, camera, above_front(), 5e-4);
    const Traced open = trace(scene, camera, above_front(), {.shadows = false});
    const Traced shadowed = trace(scene, camera, above_front(), {.shadows = true});
    size_t darker = 0;
    for (size_t i = 0; i < camera.extent.area(); ++i)
        darker += shadowed.radiance.pixels()[i].g < 0.9f * open.radiance.pixels()[i].g;
    EXPECT_GT(darker, camera.extent.area() / 100);
}

TEST_F(TraceSceneTest, FacingDiffusePlaneIsKdOverPiTimesIntensityOverSquaredDistance) {
    const double distance_m = 1.7;
    SyntheticScene scene;
    scene.name = "plane";
    const glm::dvec3 kd(0.2, 0.5, 0.8), intensity(3, 2, 1);
    scene.objects = {{{{scenes::RectangleShape{{5, 5}}, scenes::placed({0, 0, distance_m}, {1, 0, 0}, 0)}},
                      sensor::Material{9, "plane", kd, glm::dvec3(0), 0.1}}};
    scene.lights = {{{0, 0, 0}, intensity}};  // at the camera
    for (const Extent2D extent : {Extent2D{1, 1}, {9, 9}, {65, 33}}) {
        const Intrinsics camera{extent, 50, 50, (extent.width - 1) / 2.0, (extent.height - 1) / 2.0, {}};
        const Traced got = trace(scene, camera, RigidTransform(1.0));
        const uint32_t x = extent.width / 2, y = extent.height / 2;
        for (int c = 0; c < 3; ++c) {
            const double expected = kd[c] / std::numbers::pi * intensity[c] / (distance_m * distance_m);
            EXPECT_NEAR(got.radiance.at(x, y)[c], expected, 1e-5 * expected);
        }
        EXPECT_EQ(got.normal(x, y), glm::vec3(0, 0, -1));
        for (const float depth_m : got.depth_m.pixels()) EXPECT_NEAR(depth_m, distance_m, 1e-6);
        EXPECT_THAT(got.object_id.pixels(), ::testing::Each(9u));
    }
}

TEST_F(TraceSceneTest, BoxShowsEachOfItsSixNormals) {
    SyntheticScene scene;
    scene.name = "box";
    const RigidTransform world_from_box = scenes::placed({0.3, -0.2, 0.1}, {3, 1, 2}, 0.8);
    scene.objects = {
        {{{scenes::BoxShape{{0.2, 0.3, 0.4}}, world_from_box}}, {1, "box", glm::dvec3(1), glm::dvec3(0), 1}}};
    const Intrinsics camera{{5, 5}, 200, 200, 2, 2, {}};
    for (int axis = 0; axis < 3; ++axis) {
        for (const double sign : {-1.0, 1.0}) {
            const glm::dvec3 outward = sign * glm::dvec3(world_from_box[axis]);
            const glm::dvec3 right(world_from_box[(axis + 1) % 3]), down = glm::cross(-outward, right);
            const glm::dvec3 center_m = glm::dvec3(world_from_box[3]) + 2.0 * outward;
            const RigidTransform pose(glm::dvec4(right, 0), glm::dvec4(down, 0), glm::dvec4(-outward, 0),
                                      glm::dvec4(center_m, 1));
            const Traced got = trace(scene, camera, pose);
            EXPECT_LT(glm::distance(got.normal(2, 2), glm::vec3(outward)), 1e-3f) << axis << ' ' << sign;
            EXPECT_NEAR(got.depth_m.at(2, 2), 2.0 - 0.1 * (axis + 2), 1e-6) << axis << ' ' << sign;
        }
    }
}

// A light within the plane and one behind it: the Ward lobe has no value there, and must not become infinite or NaN.
TEST_F(TraceSceneTest, LightsAtAndBelowTheHorizonAddNothing) {
    SyntheticScene scene = mixed_scene();
    scene.objects = {{{{scenes::RectangleShape{{5, 5}}, scenes::placed({0, 0, 2}, {1, 0, 0}, 0)}},
                      {1, "plane", glm::dvec3(0.5), glm::dvec3(0.5), 0.05}}};
    scene.lights = {{{1, 0, 2}, {9, 9, 9}}, {{0, 0, 3}, {9, 9, 9}}, {{0, 0, 2}, {9, 9, 9}}};
    const Traced got = trace(scene, camera_of({33, 33}), RigidTransform(1.0));
    EXPECT_THAT(got.radiance.pixels(), ::testing::Each(glm::vec4(0, 0, 0, 1)));
}

TEST_F(TraceSceneTest, EmptySceneIsAllZero) {
    SyntheticScene scene;
    scene.name = "empty";
    const Traced got = trace(scene, camera_of({33, 5}), RigidTransform(1.0));
    EXPECT_THAT(got.radiance.pixels(), ::testing::Each(glm::vec4(0)));
    EXPECT_THAT(got.depth_m.pixels(), ::testing::Each(0.0f));
    EXPECT_THAT(got.object_id.pixels(), ::testing::Each(0u));
}

TEST_F(TraceSceneTest, RefusesWhatItCannotTrace) {
    const auto expect_error = [&](const char* message, auto spoil) {
        SyntheticScene scene = mixed_scene();
        spoil(scene);
        try {
            const scenes::SceneModel model(runner(), scene);
            graph::FrameGraph frame = runner().begin();
            scenes::add_render(frame, model, scene.camera, RigidTransform(1.0));
            ADD_FAILURE() << "no error: " << message;
        } catch (const Error& error) {
            EXPECT_THAT(error.what(), ::testing::HasSubstr(message));
        }
    };
    expect_error("has id 0,", [](SyntheticScene& s) { s.objects[1].material.id = 0; });
    expect_error("has id 65536,", [](SyntheticScene& s) { s.objects[1].material.id = 65536; });
    expect_error("another object's", [](SyntheticScene& s) { s.objects[1].material.id = 7; });
    expect_error("neither kd", [](SyntheticScene& s) { s.objects[1].material.kd.reset(); });
    expect_error("alpha 0,", [](SyntheticScene& s) { s.objects[1].material.alpha = 0; });
    const auto spoil_mesh = [](SyntheticScene& s, auto spoil) {
        scenes::TriangleMesh mesh = icosphere(0);
        spoil(mesh);
        s.objects[0].parts = {part_at(shape_of(mesh), {0, 0, 0})};
    };
    expect_error("has a triangle with vertex 12 of 12", [&](SyntheticScene& s) {
        spoil_mesh(s, [](scenes::TriangleMesh& mesh) { mesh.triangles[3].y = 12; });
    });
    expect_error("has 11 normals for 12 positions", [&](SyntheticScene& s) {
        spoil_mesh(s, [](scenes::TriangleMesh& mesh) { mesh.normals.pop_back(); });
    });
    expect_error("texture without texels", [](SyntheticScene& s) { s.objects[0].texture.emplace(); });
    expect_error("distortion", [](SyntheticScene& s) { s.camera.distortion[0] = 0.1; });
}

}  // namespace
}  // namespace patina::trace_scene_test
