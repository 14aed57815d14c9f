#include "tests/reference/trace_scene.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "sensor/synthetic/render.h"
#include "sensor/synthetic/scene_file.h"
#include "tests/gpu/gpu_test.h"

namespace patina {
namespace {

using sensor::RenderSettings;
using sensor::Scene;

class TraceSceneTest : public GpuTest {
  protected:
    struct Traced {
        Image<glm::vec4> radiance;
        Image<float> depth_m;
        Image<uint32_t> object_id;
        Image<glm::vec4> normals;

        glm::vec3 normal(uint32_t x, uint32_t y) const { return glm::vec3(normals.at(x, y)); }
    };

    Traced trace(const Scene& scene, const Intrinsics& camera, const RigidTransform& world_from_camera,
                 const RenderSettings& settings = {.shadows = false}) {
        const sensor::SceneModel model(runner(), scene);
        graph::Frame frame = runner().begin();
        const auto images = sensor::add_render(frame, model, camera, world_from_camera, settings);
        const auto radiance = frame.read_back(images.radiance), depth_m = frame.read_back(images.depth_m);
        const auto object_id = frame.read_back(images.object_id), normal = frame.read_back(images.normal);
        run(std::move(frame));
        return {radiance.image<glm::vec4>(), depth_m.image<float>(), object_id.image<uint32_t>(),
                normal.image<glm::vec4>()};
    }

    /// How many pixels show another object than the reference does.
    static size_t count_other_ids(const Traced& got, const Image<reference::TracedPixel>& expected) {
        size_t count = 0;
        for (size_t i = 0; i < expected.pixels().size(); ++i)
            count += got.object_id.pixels()[i] != expected.pixels()[i].object_id;
        return count;
    }

    /// Compares all pixels at which both see the same surface: one object and, up to half precision, one normal.
    /// Returns how many do not.
    static size_t compare(const Traced& got, const Image<reference::TracedPixel>& expected);
};

size_t TraceSceneTest::compare(const Traced& got, const Image<reference::TracedPixel>& expected) {
    const Extent2D extent = expected.extent();
    double worst_depth_m = 0, worst_radiance = 0;
    size_t different = 0;
    for (uint32_t y = 0; y < extent.height; ++y) {
        for (uint32_t x = 0; x < extent.width; ++x) {
            const reference::TracedPixel& e = expected.at(x, y);
            const glm::dvec3 normal(got.normal(x, y));
            if (got.object_id.at(x, y) != e.object_id || glm::distance(normal, e.normal) > 2e-3) {
                ++different;
                continue;
            }
            const glm::dvec4 radiance(got.radiance.at(x, y));
            EXPECT_EQ(radiance.a, e.object_id == 0 ? 0 : 1);
            worst_depth_m = std::max(worst_depth_m, std::abs(got.depth_m.at(x, y) - e.depth_m));
            // Half a step of an 8-bit linear code would be 2e-3: below 1e-3, errors relative to it are no errors.
            for (int c = 0; c < 3; ++c) {
                const double error = std::abs(radiance[c] - e.radiance[c]) / std::max(e.radiance[c], 1e-3);
                worst_radiance = std::max(worst_radiance, error);
            }
        }
    }
    EXPECT_LT(worst_depth_m, 1e-4);
    EXPECT_LT(worst_radiance, 1e-3);
    return different;
}

/// A camera for an extent, with the built-in scene's field of view.
Intrinsics camera_of(Extent2D extent) { return scaled_to(Scene{}.camera, extent); }

/// A rectangle, a turned box and two spheres, so that every kind hides and shadows every other.
Scene mixed_scene() {
    Scene scene;
    scene.name = "mixed";
    const sensor::Material gloss{1, "gloss", glm::dvec3(0.3, 0.2, 0.1), glm::dvec3(0.1, 0.2, 0.3), 0.15};
    const auto with_id = [&](uint32_t id) { return sensor::Material{id, "", gloss.kd, gloss.ks, gloss.alpha}; };
    scene.objects = {
        {{{sensor::SphereShape{0.5}, sensor::placed({-0.6, -0.5, 0.2}, {0, 1, 0}, 0)}}, with_id(7)},
        {{{sensor::BoxShape{{0.3, 0.2, 0.4}}, sensor::placed({0.5, -0.6, -0.3}, {1, 2, 3}, 0.9)}}, with_id(65535)},
        {{{sensor::RectangleShape{{1.5, 1.0}}, sensor::placed({0, 0, 0}, {1, 0, 0}, 1.4)}}, gloss},
        {{{sensor::SphereShape{0.2}, sensor::placed({0.2, -0.3, -0.9}, {0, 1, 0}, 0)}}, with_id(3)},
    };
    scene.lights = {{{1.5, -2.5, -2.0}, {4, 5, 6}}, {{-2.0, -1.5, -1.0}, {3, 3, 3}}};
    return scene;
}

/// Looks at the mixed scene from the front and above.
RigidTransform above_front() { return sensor::placed({0.05, -1.6, -3}, {1, 0, 0}, -0.4); }

TEST_F(TraceSceneTest, MatchesTheReferenceOnCubes) {
    const Scene scene = sensor::load_scene("cubes");
    for (const Extent2D extent : {Extent2D{1, 1}, {8, 8}, {13, 7}, {32, 4}, {65, 33}, {512, 424}}) {
        for (const double time_s : {0.0, 7.3, 21.0}) {
            SCOPED_TRACE(text(extent, " at ", time_s, " s"));
            const RigidTransform pose = world_from_camera(scene.path, time_s);
            const Traced got = trace(scene, camera_of(extent), pose);
            const auto expected = reference::trace_scene(scene, camera_of(extent), pose);
            // Rays that pass an edge closer than fp32 can tell: none or few.
            EXPECT_LE(count_other_ids(got, expected), extent.area() / 20000);
            EXPECT_LE(compare(got, expected), extent.area() / 10000);
        }
    }
}

TEST_F(TraceSceneTest, MatchesTheReferenceOnAllShapesWithAndWithoutShadows) {
    const Scene scene = mixed_scene();
    const Intrinsics camera = camera_of({301, 203});
    std::vector<glm::vec4> unshadowed;
    for (const bool hard : {false, true}) {
        const Traced got = trace(scene, camera, above_front(), {.shadows = hard});
        auto expected = reference::trace_scene(scene, camera, above_front(), hard);
        EXPECT_LE(count_other_ids(got, expected), 3u);
        if (!hard) {
            EXPECT_LE(compare(got, expected), 6u);
            unshadowed = got.radiance.pixels();
            continue;
        }
        // A shadow's edge falls on one side of a pixel or on the other; a third of the picture does not.
        size_t different = 0, darker = 0;
        for (size_t i = 0; i < unshadowed.size(); ++i) {
            const glm::vec3 color(got.radiance.pixels()[i]);
            different += glm::distance(color, glm::vec3(expected.pixels()[i].radiance)) > 1e-3f;
            darker += color.g < 0.9f * unshadowed[i].g;
        }
        EXPECT_LE(different, unshadowed.size() / 500);
        EXPECT_GT(darker, unshadowed.size() / 100);
    }
}

TEST_F(TraceSceneTest, FacingDiffusePlaneIsKdOverPiTimesIntensityOverSquaredDistance) {
    const double distance_m = 1.7;
    Scene scene;
    scene.name = "plane";
    const glm::dvec3 kd(0.2, 0.5, 0.8), intensity(3, 2, 1);
    scene.objects = {{{{sensor::RectangleShape{{5, 5}}, sensor::placed({0, 0, distance_m}, {1, 0, 0}, 0)}},
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
    Scene scene;
    scene.name = "box";
    const RigidTransform world_from_box = sensor::placed({0.3, -0.2, 0.1}, {3, 1, 2}, 0.8);
    scene.objects = {
        {{{sensor::BoxShape{{0.2, 0.3, 0.4}}, world_from_box}}, {1, "box", glm::dvec3(1), glm::dvec3(0), 1}}};
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
    Scene scene = mixed_scene();
    scene.objects = {{{{sensor::RectangleShape{{5, 5}}, sensor::placed({0, 0, 2}, {1, 0, 0}, 0)}},
                      {1, "plane", glm::dvec3(0.5), glm::dvec3(0.5), 0.05}}};
    scene.lights = {{{1, 0, 2}, {9, 9, 9}}, {{0, 0, 3}, {9, 9, 9}}, {{0, 0, 2}, {9, 9, 9}}};
    const Traced got = trace(scene, camera_of({33, 33}), RigidTransform(1.0));
    EXPECT_THAT(got.radiance.pixels(), ::testing::Each(glm::vec4(0, 0, 0, 1)));
}

TEST_F(TraceSceneTest, EmptySceneIsAllZero) {
    Scene scene;
    scene.name = "empty";
    const Traced got = trace(scene, camera_of({33, 5}), RigidTransform(1.0));
    EXPECT_THAT(got.radiance.pixels(), ::testing::Each(glm::vec4(0)));
    EXPECT_THAT(got.depth_m.pixels(), ::testing::Each(0.0f));
    EXPECT_THAT(got.object_id.pixels(), ::testing::Each(0u));
}

TEST_F(TraceSceneTest, RefusesWhatItCannotTrace) {
    const auto expect_error = [&](const char* message, auto spoil) {
        Scene scene = mixed_scene();
        spoil(scene);
        try {
            const sensor::SceneModel model(runner(), scene);
            graph::Frame frame = runner().begin();
            sensor::add_render(frame, model, scene.camera, RigidTransform(1.0));
            ADD_FAILURE() << "no error: " << message;
        } catch (const Error& error) {
            EXPECT_THAT(error.what(), ::testing::HasSubstr(message));
        }
    };
    expect_error("has id 0,", [](Scene& s) { s.objects[1].material.id = 0; });
    expect_error("has id 65536,", [](Scene& s) { s.objects[1].material.id = 65536; });
    expect_error("another object's", [](Scene& s) { s.objects[1].material.id = 7; });
    expect_error("neither kd", [](Scene& s) { s.objects[1].material.kd.reset(); });
    expect_error("alpha 0,", [](Scene& s) { s.objects[1].material.alpha = 0; });
    expect_error("distortion", [](Scene& s) { s.camera.distortion[0] = 0.1; });
}

}  // namespace
}  // namespace patina
