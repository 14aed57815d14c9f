#include "scenes/render/gather_light.h"

#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include "engine/core/error.h"
#include "tests/gpu/scenes/trace_rig.h"
#include "tests/reference/scenes/gather_light.h"
#include "tests/reference/scenes/sampling.h"

namespace patina::gather_light_test {
namespace {

using scenes::RenderSettings;
using scenes::SyntheticScene;
using std::numbers::pi;

sensor::Material diffuse(double kd) { return {1, "diffuse", glm::dvec3(kd), glm::dvec3(0), 1}; }

scenes::Environment environment_of(Image<glm::vec3> radiance) {
    return {std::make_shared<const Image<glm::vec3>>(std::move(radiance))};
}

/// Sees a field so narrow that all pixels look in one direction.
Intrinsics narrow_camera(uint32_t side) { return {{side, side}, 1e5, 1e5, (side - 1) / 2.0, (side - 1) / 2.0, {}}; }

/// A plane across the z axis, 2 m in front of a narrow camera, turned about the x axis.
SyntheticScene plane(sensor::Material material, double angle_rad) {
    SyntheticScene scene;
    scene.objects = {{{part_at(scenes::RectangleShape{{50, 50}}, {0, 0, 2}, {1, 0, 0}, angle_rad)}, material}};
    return scene;
}

class GatherLightTest : public TraceTest {
  protected:
    struct Statistics {
        glm::dvec3 mean{0};
        double error = 0;  ///< standard error of the mean's green
    };

    static Statistics statistics(const Image<glm::vec4>& radiance) {
        Statistics s;
        double sum2 = 0;
        const auto n = static_cast<double>(radiance.pixels().size());
        for (const glm::vec4& color : radiance.pixels()) s.mean += glm::dvec3(color) / n;
        for (const glm::vec4& color : radiance.pixels()) sum2 += (color.g - s.mean.g) * (color.g - s.mean.g);
        s.error = std::sqrt(sum2 / (n - 1) / n);
        return s;
    }

    Statistics mean_radiance(const SyntheticScene& scene, const RenderSettings& settings, uint32_t side = 32) {
        return statistics(trace(scene, narrow_camera(side), RigidTransform(1.0), settings).radiance);
    }

    /// Within four standard errors, as the pixels' scatter tells them, and fp32's rounding.
    static void expect_mean(const Statistics& got, double expected, double largest_error) {
        EXPECT_NEAR(got.mean.g, expected, 4 * got.error + 1e-4 * expected);
        EXPECT_LE(got.error, largest_error * expected) << "too noisy to tell";
    }
};

// Inside a diffuse sphere with a point light in its centre every surface point receives the same from everywhere, so
// that every single path finds its part of the geometric series exactly.
TEST_F(GatherLightTest, BouncesAgreeWithTheDiffuseFurnace) {
    const double radius_m = 1.5, albedo = 0.7, intensity = 3;
    SyntheticScene scene;
    scene.objects = {{{part_at(scenes::SphereShape{radius_m}, {0, 0, 0})}, diffuse(albedo)}};
    const RigidTransform pose = scenes::placed({0.3, -0.2, 0.4}, {1, 1, 0}, 0.5);
    for (const double lamp_radius_m : {0.0, 0.2}) {
        scene.lights = {{{0, 0, 0}, glm::dvec3(intensity), lamp_radius_m}};
        double series = 0;
        for (uint32_t bounces = 0; bounces <= 4; ++bounces) {
            series += std::pow(albedo, bounces);
            const double expected = albedo / pi * intensity / (radius_m * radius_m) * series;
            const RenderSettings settings{.area_lights = true, .bounces = bounces, .samples = 6};
            const Traced got = trace(scene, camera_of({32, 24}), pose, settings);
            // What a ray sees of a lamp at 1.5 m, 0.2 m in radius, has cosines of 0.991 to 1.
            for (size_t i = 0; i < got.object_id.pixels().size(); ++i) {
                if (got.object_id.pixels()[i] == 0) continue;  // the lamp itself
                ASSERT_NEAR(got.radiance.pixels()[i].g, expected, (lamp_radius_m == 0 ? 1e-5 : 0.01) * expected);
            }
        }
    }
}

TEST_F(GatherLightTest, ConvexDiffuseObjectUnderAUniformSkyShowsKdTimesIt) {
    const double sky = 0.8;
    for (const double kd : {1.0, 0.3}) {
        SyntheticScene scene;
        scene.environment = environment_of(Image<glm::vec3>({8, 4}, glm::vec3(sky)));
        scene.objects = {{{part_at(scenes::SphereShape{0.5}, {0, 0, 3})}, diffuse(kd)}};
        const Traced got = trace(scene, camera_of({48, 40}), RigidTransform(1.0), {.bounces = 1, .samples = 64});
        double mean = 0, square = 0, count = 0;
        for (size_t i = 0; i < got.object_id.pixels().size(); ++i) {
            const glm::vec4 color = got.radiance.pixels()[i];
            if (got.object_id.pixels()[i] == 0) {
                EXPECT_EQ(color, glm::vec4(glm::vec3(sky), 0)) << "the sky itself";
                EXPECT_EQ(got.depth_m.pixels()[i], 0);
                continue;
            }
            EXPECT_EQ(color.a, 1);
            mean += color.g, square += color.g * color.g, ++count;
        }
        mean /= count;
        const double deviation = std::sqrt(square / count - mean * mean);
        EXPECT_GT(count, 100);
        EXPECT_NEAR(mean, kd * sky, 4 * deviation / std::sqrt(count) + 1e-4);
        EXPECT_LT(deviation, 0.1 * kd * sky);
    }
}

// A lamp reflects nothing: it shows what it emits, before whatever sky, and with whatever paths its neighbours take.
TEST_F(GatherLightTest, LampsShowWhatTheyEmitBeforeASky) {
    const double intensity = 2, radius_m = 0.3, emitted = intensity / (pi * radius_m * radius_m);
    SyntheticScene scene = plane(diffuse(0.5), 0);
    scene.environment = environment_of(Image<glm::vec3>({8, 4}, glm::vec3(0.8f)));
    scene.lights = {{{0, 0, 1.5}, glm::dvec3(intensity), radius_m}};
    const Traced got =
        trace(scene, camera_of({32, 24}), RigidTransform(1.0), {.area_lights = true, .bounces = 2, .samples = 16});
    int lamp = 0;
    for (size_t i = 0; i < got.object_id.pixels().size(); ++i) {
        if (got.object_id.pixels()[i] != 0 || !got.hit(i)) continue;
        ASSERT_NEAR(got.radiance.pixels()[i].g, emitted, 1e-5 * emitted) << "pixel " << i;
        ++lamp;
    }
    EXPECT_GT(lamp, 20);
}

// Within an enclosure that reflects everything, open to a uniform sky through one side, light has one radiance only:
// what is missing after n bounces is what has not left yet.
TEST_F(GatherLightTest, ManyBouncesMakeAWhiteBowlVanishBeforeAUniformSky) {
    SyntheticScene scene;
    scene.environment = environment_of(Image<glm::vec3>({4, 2}, glm::vec3(1)));
    scenes::SceneObject bowl{{}, diffuse(1)};
    for (const auto& [axis, position_m] :
         {std::pair(glm::dvec3(1, 0, 0), glm::dvec3(0, 0.5, 3)), std::pair(glm::dvec3(1, 0, 0), glm::dvec3(0, -0.5, 3)),
          std::pair(glm::dvec3(0, 1, 0), glm::dvec3(0.5, 0, 3)),
          std::pair(glm::dvec3(0, 1, 0), glm::dvec3(-0.5, 0, 3))})
        bowl.parts.push_back(part_at(scenes::RectangleShape{{0.5, 0.5}}, position_m, axis, pi / 2));
    bowl.parts.push_back(part_at(scenes::RectangleShape{{0.5, 0.5}}, {0, 0, 3.5}));
    scene.objects = {bowl};
    const Statistics dark = mean_radiance(scene, {.bounces = 0, .samples = 32}, 16);
    const Statistics bright = mean_radiance(scene, {.bounces = 40, .samples = 16}, 16);
    EXPECT_LT(dark.mean.g, 0.7);
    EXPECT_NEAR(bright.mean.g, 1, 4 * bright.error + 0.02);
}

// A sphere that is wholly above the horizon has the irradiance of a point of its intensity: pi L (r / d)^2 cos.
TEST_F(GatherLightTest, DiffusePlaneUnderASphereLampHasTheClosedFormsIrradiance) {
    const double kd = 0.6, intensity = 2;
    const glm::dvec3 lamp_m(0.7, -0.4, 1.0);
    for (const double radius_m : {0.0, 0.05, 0.4, 0.8}) {
        SyntheticScene scene = plane(diffuse(kd), 0);
        scene.lights = {{lamp_m, glm::dvec3(intensity), radius_m}};
        const glm::dvec3 offset_m = lamp_m - glm::dvec3(0, 0, 2);
        const double d = glm::length(offset_m), cosine = -offset_m.z / d;
        const double radiance = radius_m > 0 ? scenes::emitted_radiance(scene.lights[0]).g : 0;
        const double irradiance =
            radius_m > 0 ? pi * radiance * std::pow(radius_m / d, 2) * cosine : intensity / (d * d) * cosine;
        const Statistics got = mean_radiance(scene, {.area_lights = true, .samples = 64});
        expect_mean(got, kd / pi * irradiance, 1e-3);
    }
}

// What stands between the plane and half of the lamp takes half of its light, if shadows are asked for.
TEST_F(GatherLightTest, ScreenBeforeHalfOfALampTakesHalfOfItsLight) {
    SyntheticScene scene = plane(diffuse(0.5), 0);
    scene.lights = {{{0, 0, -2}, glm::dvec3(4), 0.5}};
    const double whole = 0.5 / pi * 4 / 16;
    expect_mean(mean_radiance(scene, {.area_lights = true, .samples = 64}), whole, 1e-3);
    // Behind the camera; its edge on the axis, beside which it leaves the pinhole free.
    scene.objects.push_back({{part_at(scenes::RectangleShape{{1, 1}}, {1, 0, -0.5})}, diffuse(0)});
    scene.objects.back().material.id = 2;
    expect_mean(mean_radiance(scene, {.area_lights = true, .samples = 64}), whole / 2, 1e-2);
    expect_mean(mean_radiance(scene, {.shadows = false, .area_lights = true, .samples = 64}), whole, 1e-3);
}

// A highlight's mean over a lamp of radius r differs from its centre's value by the second derivative times r^2.
TEST_F(GatherLightTest, SphereLampConvergesToThePointLightWithTheSquareOfItsRadius) {
    SyntheticScene scene = plane({1, "gloss", glm::dvec3(0.1), glm::dvec3(0.3), 0.25}, 0.2);
    scene.lights = {{{0.0, 0.5, 0.4}, glm::dvec3(2)}};  // beside what the camera sees
    const double point = mean_radiance(scene, {}, 8).mean.g;
    double previous = 0;
    for (const double radius_m : {0.32, 0.16, 0.08, 0.04, 0.02}) {
        scene.lights[0].radius_m = radius_m;
        const Statistics got = mean_radiance(scene, {.area_lights = true, .samples = 256});
        const double difference = std::abs(got.mean.g / point - 1);
        RecordProperty("difference_at_" + std::to_string(radius_m), testing::PrintToString(difference));
        EXPECT_LT(4 * got.error / point, 0.3 * difference) << "too noisy to tell";
        if (previous > 0) {
            EXPECT_GT(previous / difference, 3) << radius_m;
            EXPECT_LT(previous / difference, 5) << radius_m;
        }
        previous = difference;
    }
    EXPECT_LT(previous, 3e-3);
}

/// A picture of smooth sky, dark ground and a bright spot.
Image<glm::vec3> uneven_sky() {
    Image<glm::vec3> picture({32, 16}, glm::vec3(0.05f));
    for (uint32_t y = 0; y < 8; ++y)
        for (uint32_t x = 0; x < 32; ++x)
            picture.at(x, y) = glm::vec3(0.3f, 0.4f, 0.6f) + 0.2f * std::sin(0.4f * static_cast<float>(x));
    picture.at(13, 6) = picture.at(14, 6) = glm::vec3(20, 16, 12);
    return picture;
}

/// The radiance that a viewer of direction `to_viewer` sees, by quadrature within every cell of a picture.
glm::dvec3 quadrature(const reference::Ward& material, glm::dvec3 normal, glm::dvec3 to_viewer,
                      const Image<glm::vec3>& picture) {
    constexpr int kSteps = 20;
    const uint32_t width = picture.extent().width, height = picture.extent().height;
    const double theta_step = pi / (height * kSteps), phi_step = 2 * pi / (width * kSteps);
    glm::dvec3 sum(0);
    for (uint32_t y = 0; y < height * kSteps; ++y) {
        for (uint32_t x = 0; x < width * kSteps; ++x) {
            // As scene.h says: the top row is up, at -y; the centre column at +z; the right of it towards +x.
            const double theta = (y + 0.5) * theta_step, phi = (x + 0.5) * phi_step - pi;
            const glm::dvec3 d(std::sin(theta) * std::sin(phi), -std::cos(theta), std::sin(theta) * std::cos(phi));
            if (glm::dot(d, normal) <= 0) continue;
            sum += reference::ward(material, normal, d, to_viewer) * glm::dot(d, normal) *
                   glm::dvec3(picture.at(x / kSteps, y / kSteps)) * std::sin(theta) * theta_step * phi_step;
        }
    }
    return sum;
}

TEST_F(GatherLightTest, WardLobesUnderAnEnvironmentMatchQuadrature) {
    const Image<glm::vec3> sky = uneven_sky();
    for (const double angle_rad : {-0.9, -0.3}) {
        for (const double alpha : {0.08, 0.3, 0.8}) {
            SCOPED_TRACE(testing::Message() << angle_rad << ", alpha " << alpha);
            SyntheticScene scene =
                plane({1, "", glm::dvec3(0.2, 0.1, 0.3), glm::dvec3(0.4, 0.3, 0.2), alpha}, angle_rad);
            scene.environment = environment_of(sky);
            const Traced got = trace(scene, narrow_camera(32), RigidTransform(1.0), {.samples = 64});
            const Statistics s = statistics(got.radiance);
            const glm::dvec3 normal(glm::vec3(got.normals.at(16, 16)));
            const glm::dvec3 expected =
                quadrature({glm::dvec3(0.2, 0.1, 0.3), glm::dvec3(0.4, 0.3, 0.2), alpha}, normal, {0, 0, -1}, sky);
            expect_mean(s, expected.g, 5e-3);
            for (int c = 0; c < 3; ++c) EXPECT_NEAR(s.mean[c], expected[c], 0.02 * expected[c]);
        }
    }
}

// The background shows the picture where scene.h says: up, ahead and to the right.
TEST_F(GatherLightTest, EnvironmentIsSeenInItsDirections) {
    Image<glm::vec3> picture({8, 4});
    for (size_t i = 0; i < 32; ++i) picture.pixels()[i] = glm::vec3(static_cast<float>(i));
    SyntheticScene scene;
    scene.environment = environment_of(picture);
    for (uint32_t y = 0; y < 4; ++y) {
        for (uint32_t x = 0; x < 8; ++x) {
            const double theta = (y + 0.5) * pi / 4, phi = (x + 0.5) * pi / 4 - pi;
            const RigidTransform pose =
                scenes::placed({1, 2, 3}, {0, 1, 0}, phi) * scenes::placed({0, 0, 0}, {1, 0, 0}, pi / 2 - theta);
            const Traced got = trace(scene, narrow_camera(1), pose);
            EXPECT_EQ(got.radiance.at(0, 0), glm::vec4(glm::vec3(static_cast<float>(8 * y + x)), 0)) << x << ' ' << y;
        }
    }
}

// Up to 75 degrees a lobe of ks = 1 under a white sky reflects what quadrature says, and no more than arrives.
TEST_F(GatherLightTest, GlossyPlaneKeepsItsEnergyUnderAWhiteSky) {
    for (const double degrees : {0.0, 45.0, 75.0}) {
        SyntheticScene scene = plane({1, "", glm::dvec3(0), glm::dvec3(1), 0.2}, degrees * pi / 180);
        scene.environment = environment_of(Image<glm::vec3>({4, 2}, glm::vec3(1)));
        const Statistics got = mean_radiance(scene, {.samples = 64});
        const reference::Ward material{glm::dvec3(0), glm::dvec3(1), 0.2};
        expect_mean(got, reference::ward_albedo(material, degrees * pi / 180).g, 5e-3);
        EXPECT_LT(got.mean.g, 1);
    }
}

/// A corner of matt and glossy things under two lamps and the uneven sky.
SyntheticScene mixed_scene() {
    SyntheticScene scene;
    scene.objects = {glossy(1, {part_at(scenes::RectangleShape{{2, 2}}, {0, 0.6, 3}, {1, 0, 0}, pi / 2)}),
                     glossy(2, {part_at(scenes::RectangleShape{{2, 2}}, {0, 0, 4}, {1, 0, 0}, 0.1)}),
                     glossy(3, {part_at(scenes::BoxShape{{0.3, 0.3, 0.3}}, {-0.4, 0.3, 2.8}, {0, 1, 0}, 0.5)}),
                     glossy(4, {part_at(scenes::SphereShape{0.35}, {0.5, 0.25, 2.9})})};
    for (auto& object : scene.objects) object.material.alpha = 0.4;
    scene.lights = {{{1, -1.5, 2}, {3, 3, 2}, 0.3, {-0.6, 0.8, 0}}, {{-1.2, -0.5, 1.5}, {1, 2, 2}}};
    scene.environment = environment_of(uneven_sky());
    return scene;
}

// Lamps, environment, shadows and one bounce together, on matt and glossy surfaces: every pixel is as far off as chance
// makes it, and no more.
TEST_F(GatherLightTest, MixedSceneMatchesTheDoubleReference) {
    constexpr int kRuns = 8;
    const SyntheticScene scene = mixed_scene();
    const Intrinsics camera = camera_of({20, 16});
    const auto expected = reference::gather_light(scene, camera, RigidTransform(1.0), 4000);
    std::vector<Traced> runs;
    for (uint64_t seed = 0; seed < kRuns; ++seed)
        runs.push_back(trace(scene, camera, RigidTransform(1.0),
                             {.area_lights = true, .bounces = 1, .samples = 64, .seed = seed}));
    double chi2 = 0, bias = 0, total = 0, pixels = 0;
    for (size_t i = 0; i < expected.pixels().size(); ++i) {
        if (runs[0].object_id.pixels()[i] == 0) continue;
        double mean = 0, square = 0;
        for (const Traced& run : runs) {
            const double green = run.radiance.pixels()[i].g;
            mean += green / kRuns, square += green * green / kRuns;
        }
        const double variance = (square - mean * mean) / (kRuns - 1) + std::pow(expected.pixels()[i].error.g, 2);
        const double off = mean - expected.pixels()[i].radiance.g;
        EXPECT_LT(std::abs(off), 6 * std::sqrt(variance) + 1e-4) << "pixel " << i;
        chi2 += off * off / variance, bias += off, total += mean, ++pixels;
    }
    EXPECT_GT(pixels, 200);
    EXPECT_LT(chi2 / pixels, 1.6);
    EXPECT_LT(std::abs(bias / total), 5e-3);
}

TEST_F(GatherLightTest, SameSeedSameBytesAnotherSeedOrFrameOthers) {
    const SyntheticScene scene = mixed_scene();
    const auto render = [&](uint64_t seed, uint32_t frame_index) {
        const scenes::SceneModel model(runner(), scene);
        graph::FrameGraph frame = runner().begin();
        const RenderSettings settings{.area_lights = true, .bounces = 1, .samples = 5, .seed = seed};
        const auto images =
            scenes::add_render(frame, model, camera_of({37, 19}), RigidTransform(1.0), settings, frame_index);
        const auto radiance = frame.read_back(images.radiance);
        run(std::move(frame));
        return radiance.image<glm::vec4>().pixels();
    };
    const auto first = render(7, 0);
    EXPECT_EQ(first, render(7, 0));
    for (const auto& other : {render(8, 0), render(7 + (uint64_t{1} << 32), 0), render(7, 1)}) {
        size_t different = 0;
        for (size_t i = 0; i < first.size(); ++i) different += first[i] != other[i];
        EXPECT_GT(different, first.size() / 4);
    }
}

TEST_F(GatherLightTest, WithoutAnythingToSampleLightIsEquation6Exactly) {
    SyntheticScene scene = mixed_scene();
    scene.environment.reset();
    const auto plain = trace(scene, camera_of({37, 19}), RigidTransform(1.0), {.samples = 0});
    scene.lights[0].radius_m = 0;
    const auto point = trace(scene, camera_of({37, 19}), RigidTransform(1.0), {.area_lights = true, .samples = 0});
    for (size_t i = 0; i < plain.radiance.pixels().size(); ++i) {
        if (plain.object_id.pixels()[i] != 0) {
            EXPECT_EQ(plain.radiance.pixels()[i], point.radiance.pixels()[i]);
        }
    }
}

TEST_F(GatherLightTest, RefusesToSampleWithoutSamples) {
    const SyntheticScene scene = mixed_scene();
    try {
        trace(scene, camera_of({8, 8}), RigidTransform(1.0), {.samples = 0});
        ADD_FAILURE() << "no error";
    } catch (const Error& error) {
        EXPECT_THAT(error.what(), testing::HasSubstr("'scenes.gather_light' needs at least 1 sample"));
    }
}

}  // namespace
}  // namespace patina::gather_light_test
