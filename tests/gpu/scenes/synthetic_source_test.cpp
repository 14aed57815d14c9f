#include "scenes/render/synthetic_source.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <vector>

#include "scenes/description/lighting_sequence.h"
#include "scenes/description/noise.h"
#include "scenes/files/scene_file.h"
#include "tests/gpu/scenes/trace_rig.h"

namespace patina::synthetic_source_test {
namespace {

using scenes::SyntheticScene;

class SyntheticSourceTest : public TraceTest {
  protected:
    /// What the renderer gives for the first frame of the scene's sequence.
    Traced render(const SyntheticScene& scene) {
        return trace(scene, scene.camera, world_from_camera(scene.path, 0), scene.recording.render);
    }
};

struct Recorded {
    Frame frame;
    scenes::FrameTruth truth;
};

std::vector<Recorded> record(vulkan::Device& device, const SyntheticScene& scene,
                             const scenes::SyntheticOptions& options) {
    scenes::SyntheticSource source(device, scene, options);
    EXPECT_EQ(source.info().frames, options.frames);
    std::vector<Recorded> recorded;
    while (const auto reading = source.next()) recorded.push_back({std::get<Frame>(*reading), source.truth()});
    return recorded;
}

std::vector<Recorded> record(vulkan::Device& device, const SyntheticScene& scene, uint32_t frames) {
    return record(device, scene, scenes::SyntheticOptions{.frames = frames});
}

const std::vector<SrgbPixel>& colors(const Recorded& r) { return std::get<Image<SrgbPixel>>(r.frame.color).pixels(); }
const std::vector<uint16_t>& depths(const Recorded& r) { return std::get<Image<uint16_t>>(r.frame.depth).pixels(); }

TEST_F(SyntheticSourceTest, YieldsEveryFrameOnceWithTimePoseAndTheSameBytesEachTime) {
    const SyntheticScene scene = scenes::load_scene("cubes");
    const auto first = record(device(), scene, 3), second = record(device(), scene, 3);
    ASSERT_EQ(first.size(), 3u);
    for (uint32_t i = 0; i < 3; ++i) {
        EXPECT_EQ(first[i].frame.index, i);
        EXPECT_EQ(first[i].frame.timestamp_s, i / 30.0);
        EXPECT_EQ(first[i].frame.world_from_camera, world_from_camera(scene.path, i / 30.0));
        EXPECT_EQ(colors(first[i]), colors(second[i]));
        EXPECT_EQ(depths(first[i]), depths(second[i]));
        EXPECT_EQ(first[i].truth.labels.pixels(), second[i].truth.labels.pixels());
    }
    EXPECT_NE(depths(first[0]), depths(first[2])) << "the camera must move";
}

/// IEC 61966-2-1, the code of a linear value before rounding.
double srgb(double linear) {
    const double v = std::clamp(linear, 0.0, 1.0);
    return 255 * (v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055);
}

TEST_F(SyntheticSourceTest, EncodesColorDepthAndLabelsAsASequenceHoldsThem) {
    SyntheticScene scene = scenes::load_scene("cubes");
    scene.lights[0].intensity *= 3;  // so that some pixels are clipped
    const Recorded got = record(device(), scene, 1).front();
    const Traced rendered = render(scene);
    size_t clipped = 0;
    for (size_t i = 0; i < colors(got).size(); ++i) {
        const glm::vec4 radiance = rendered.radiance.pixels()[i];
        for (int c = 0; c < 3; ++c) {
            // Half a code of rounding, and what a device's pow may be off by.
            ASSERT_NEAR(colors(got)[i][c], srgb(radiance[c]), 0.51);
            clipped += radiance[c] > 1;
        }
        ASSERT_NEAR(depths(got)[i], 1000.0 * rendered.depth_m.pixels()[i], 0.501);
        ASSERT_EQ(got.truth.labels.pixels()[i], rendered.object_id.pixels()[i]);
    }
    EXPECT_GT(clipped, 100u);
}

/// The cubes in small pictures.
SyntheticScene small_cubes() {
    SyntheticScene scene = scenes::load_scene("cubes");
    scene.camera = scaled_to(scene.camera, {96, 80});
    return scene;
}

TEST_F(SyntheticSourceTest, ExposureScalesLinearColorWithoutClipping) {
    SyntheticScene scene = small_cubes();
    scene.recording.exr = true;
    scene.lights[0].intensity *= 10;
    const Recorded got = record(device(), scene, {.frames = 1, .exposure = 0.25}).front();
    EXPECT_EQ(got.frame.exposure, (Exposure{0.0025, 1}));
    const auto& pixels = std::get<Image<glm::vec3>>(got.frame.color).pixels();
    const Traced rendered = render(scene);
    float brightest = 0;
    for (size_t i = 0; i < pixels.size(); ++i) {
        ASSERT_EQ(pixels[i], 0.25f * glm::vec3(rendered.radiance.pixels()[i]));
        brightest = std::max(brightest, pixels[i].g);
    }
    EXPECT_GT(brightest, 1);
}

TEST_F(SyntheticSourceTest, ColorCameraOfItsOwnSeesFromItsPlace) {
    SyntheticScene scene = small_cubes();
    const scenes::ColorCamera color{scaled_to(SyntheticScene{}.camera, {120, 60}),
                                    scenes::placed({0.3, 0.02, -0.01}, {0.2, 1, 0}, 0.1)};
    scene.color_camera = color;
    scenes::SyntheticSource source(device(), scene, {.frames = 1, .truth_every = 1});
    EXPECT_EQ(source.info().depth, scene.camera);
    EXPECT_EQ(source.info().color, color.camera);
    EXPECT_EQ(source.info().color_from_depth, color.color_from_depth);
    const Frame got = std::get<Frame>(source.next().value());

    const RigidTransform world_from_depth = world_from_camera(scene.path, 0);
    EXPECT_EQ(got.world_from_camera, world_from_depth);
    const Traced by_depth = trace(scene, scene.camera, world_from_depth, scene.recording.render);
    const Traced by_color =
        trace(scene, color.camera, world_from_depth * rigid_inverse(color.color_from_depth), scene.recording.render);
    const auto& codes = std::get<Image<SrgbPixel>>(got.color);
    ASSERT_EQ(codes.extent(), color.camera.extent);
    for (size_t i = 0; i < codes.pixels().size(); ++i)
        ASSERT_NEAR(codes.pixels()[i].g, srgb(by_color.radiance.pixels()[i].g), 0.51);
    for (size_t i = 0; i < by_depth.depth_m.pixels().size(); ++i) {
        ASSERT_NEAR(std::get<Image<uint16_t>>(got.depth).pixels()[i], 1000 * by_depth.depth_m.pixels()[i], 0.501);
        ASSERT_EQ(source.truth().labels.pixels()[i], by_depth.object_id.pixels()[i]);
    }
    const scenes::FrameTruth::Seen& seen = source.truth().seen.value();
    EXPECT_EQ(seen.depth_m.pixels(), by_color.depth_m.pixels());
    EXPECT_EQ(seen.object_id.pixels(), by_color.object_id.pixels());
    EXPECT_EQ(seen.radiance.pixels(), by_color.radiance.pixels());
}

TEST_F(SyntheticSourceTest, NoiseDependsOnSeedAndFrameAlone) {
    SyntheticScene scene = small_cubes();
    scene.recording.noise = scenes::noise_preset("kinect2");
    scene.recording.noise.pose_translation_m = 0.01;
    std::get<scenes::OrbitPath>(scene.path).azimuth_amplitude_rad = 0;  // the camera rests: noise alone differs
    std::get<scenes::OrbitPath>(scene.path).elevation_amplitude_rad = 0;
    scene.recording.seed = 5;
    const auto first = record(device(), scene, 2), again = record(device(), scene, 2);
    scene.recording.seed = 6;
    const auto other = record(device(), scene, 2);
    for (size_t i = 0; i < 2; ++i) {
        EXPECT_EQ(colors(first[i]), colors(again[i]));
        EXPECT_EQ(depths(first[i]), depths(again[i]));
        EXPECT_EQ(first[i].frame.world_from_camera, again[i].frame.world_from_camera);
        EXPECT_NE(colors(first[i]), colors(other[i]));
        EXPECT_NE(depths(first[i]), depths(other[i]));
        EXPECT_NE(first[i].frame.world_from_camera, other[i].frame.world_from_camera);
        EXPECT_NE(first[i].frame.world_from_camera, first[i].truth.world_from_camera);
        EXPECT_EQ(first[i].truth.world_from_camera, world_from_camera(scene.path, 0));
    }
    EXPECT_NE(colors(first[0]), colors(first[1]));
    EXPECT_NE(depths(first[0]), depths(first[1]));
    EXPECT_EQ(first[0].truth.labels.pixels(), other[1].truth.labels.pixels()) << "truth has no noise";
}

TEST_F(SyntheticSourceTest, LightingSequenceShowsLampsUnclippedAndLittleElse) {
    SyntheticScene scene = small_cubes();
    scene.lights = {{{0, -1.2, -1.2}, {4, 2, 1}, 0.1}, {{0.9, -1.2, -1.2}, {1, 1, 1}, 0.1}};
    scene.lighting = scenes::LightingRecording{scene.path, 1};
    const auto lighting = scenes::lighting_sequence(scene).value();
    const Recorded got = record(device(), lighting.scene, {.frames = 1, .exposure = lighting.exposure}).front();
    EXPECT_NEAR(got.frame.exposure.exposure_s, 0.01 * 0.8 / (4 / (std::numbers::pi * 0.01)), 1e-9);
    const Traced main = render(scene);
    size_t bright = 0, dim = 0, other = 0;
    for (size_t i = 0; i < colors(got).size(); ++i) {
        const SrgbPixel color = colors(got)[i];
        if (color.r == std::lround(srgb(0.8))) {
            ++bright;
            EXPECT_EQ(color, SrgbPixel(glm::round(glm::dvec3(srgb(0.8), srgb(0.4), srgb(0.2)))));
        } else if (color.r == std::lround(srgb(0.2))) {
            ++dim;
        } else {
            EXPECT_LT(color.r, 60) << "linear 0.045";
            ++other;
            continue;
        }
        EXPECT_GT(depths(got)[i], 0) << "a lamp has depth";
        EXPECT_EQ(got.truth.labels.pixels()[i], 0);
        EXPECT_GT(main.radiance.pixels()[i].r, 1) << "and clips in the main sequence";
    }
    EXPECT_GT(bright, 10u);
    EXPECT_GT(dim, 10u);
    EXPECT_GT(other, 5000u);
}

TEST_F(SyntheticSourceTest, TruthIsSeenWhereItIsAskedFor) {
    const auto recorded = record(device(), small_cubes(), {.frames = 5, .truth_every = 2});
    ASSERT_EQ(recorded.size(), 5u);
    for (uint32_t i = 0; i < 5; ++i) EXPECT_EQ(recorded[i].truth.seen.has_value(), i % 2 == 0) << i;
}

TEST_F(SyntheticSourceTest, DepthBeyondSixteenBitsIsNoReading) {
    SyntheticScene scene = small_cubes();
    scene.metres_per_unit = 1e-5;  // 65535 units are 0.66 m
    EXPECT_THAT(depths(record(device(), scene, 1).front()), ::testing::Each(0));
}

/// How the objects of a frame appear; the background is left out.
struct Appearance {
    std::map<uint16_t, size_t> pixels_of;  ///< per object id
    double clipped = 0;                    ///< share of pixels
    double mean_green = 0;                 ///< 8-bit code
};

Appearance appearance_of(const Recorded& recorded) {
    Appearance a;
    double pixels = 0;
    for (size_t i = 0; i < colors(recorded).size(); ++i) {
        const uint16_t id = recorded.truth.labels.pixels()[i];
        if (id == 0) continue;
        const SrgbPixel color = colors(recorded)[i];
        ++pixels, ++a.pixels_of[id];
        a.clipped += std::max({color.r, color.g, color.b}) == 255;
        a.mean_green += color.g;
    }
    a.clipped /= pixels;
    a.mean_green /= pixels;
    return a;
}

/// The cubes in 15 frames over the camera path's whole minute, at half the resolution.
SyntheticScene slow_cubes() {
    SyntheticScene scene = scenes::load_scene("cubes");
    scene.camera = scaled_to(scene.camera, {256, 212});
    scene.fps = 0.25;
    return scene;
}

TEST_F(SyntheticSourceTest, CubesAreWellExposedAndAllVisible) {
    SyntheticScene scene = slow_cubes();
    scene.camera = scenes::load_scene("cubes").camera;
    for (Light& light : scene.lights) light.radius_m = 0;  // lamps in view would hide what is judged
    std::map<uint16_t, int> frames_with;
    for (const Recorded& recorded : record(device(), scene, 15)) {
        const Appearance a = appearance_of(recorded);
        EXPECT_LT(a.clipped, 0.01) << "frame " << recorded.frame.index;
        EXPECT_GT(a.mean_green, 100) << "frame " << recorded.frame.index;
        EXPECT_LT(a.mean_green, 180) << "frame " << recorded.frame.index;
        for (const auto& [id, pixels] : a.pixels_of) frames_with[id] += pixels >= 100;
    }
    EXPECT_EQ(frames_with.size(), scene.objects.size());
    for (const auto& [id, frames] : frames_with) EXPECT_GE(frames, 12) << "object " << id;
}

TEST_F(SyntheticSourceTest, MostObjectsOfCubesShowAHighlight) {
    const SyntheticScene scene = slow_cubes();
    SyntheticScene diffuse = scene;
    for (auto& object : diffuse.objects) object.material.ks = glm::dvec3(0);
    const auto glossy = record(device(), scene, 15), dull = record(device(), diffuse, 15);
    std::set<uint16_t> shown;
    for (size_t f = 0; f < glossy.size(); ++f) {
        for (size_t i = 0; i < colors(glossy[f]).size(); ++i)
            if (colors(glossy[f])[i].g > colors(dull[f])[i].g + 40) shown.insert(glossy[f].truth.labels.pixels()[i]);
    }
    EXPECT_GE(shown.size(), scene.objects.size() * 2 / 3);
}

}  // namespace
}  // namespace patina::synthetic_source_test
