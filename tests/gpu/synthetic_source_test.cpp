#include "sensor/synthetic/synthetic_source.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <vector>

#include "sensor/synthetic/render.h"
#include "sensor/synthetic/scene_file.h"
#include "tests/gpu/gpu_test.h"

namespace patina {
namespace {

using sensor::Scene;

class SyntheticSourceTest : public GpuTest {
  protected:
    struct Rendered {
        Image<glm::vec4> radiance;
        Image<float> depth_m;
        Image<uint32_t> object_id;
    };

    /// What the renderer gives for a frame of the scene's sequence.
    Rendered render(const Scene& scene, uint32_t index = 0) {
        const sensor::SceneModel model(runner(), scene);
        graph::Frame frame = runner().begin();
        const RigidTransform pose = world_from_camera(scene.path, index / scene.fps);
        const auto images = sensor::add_render(frame, model, scene.camera, pose, scene.recording.render, index);
        const auto radiance = frame.read_back(images.radiance), depth_m = frame.read_back(images.depth_m);
        const auto object_id = frame.read_back(images.object_id);
        run(std::move(frame));
        return {radiance.image<glm::vec4>(), depth_m.image<float>(), object_id.image<uint32_t>()};
    }
};

struct Recorded {
    sensor::Frame frame;
    Image<uint16_t> labels;
};

std::vector<Recorded> record(vulkan::Device& device, const Scene& scene, uint32_t frames) {
    sensor::SyntheticSource source(device, scene, frames);
    EXPECT_EQ(source.info().frames, frames);
    std::vector<Recorded> recorded;
    while (const auto reading = source.next()) recorded.push_back({std::get<sensor::Frame>(*reading), source.labels()});
    return recorded;
}

const std::vector<sensor::SrgbPixel>& colors(const Recorded& r) {
    return std::get<Image<sensor::SrgbPixel>>(r.frame.color).pixels();
}
const std::vector<uint16_t>& depths(const Recorded& r) { return std::get<Image<uint16_t>>(r.frame.depth).pixels(); }

TEST_F(SyntheticSourceTest, YieldsEveryFrameOnceWithTimePoseAndTheSameBytesEachTime) {
    const Scene scene = sensor::load_scene("cubes");
    const auto first = record(device(), scene, 3), second = record(device(), scene, 3);
    ASSERT_EQ(first.size(), 3u);
    for (uint32_t i = 0; i < 3; ++i) {
        EXPECT_EQ(first[i].frame.index, i);
        EXPECT_EQ(first[i].frame.timestamp_s, i / 30.0);
        EXPECT_EQ(first[i].frame.world_from_camera, world_from_camera(scene.path, i / 30.0));
        EXPECT_EQ(colors(first[i]), colors(second[i]));
        EXPECT_EQ(depths(first[i]), depths(second[i]));
        EXPECT_EQ(first[i].labels.pixels(), second[i].labels.pixels());
    }
    EXPECT_NE(depths(first[0]), depths(first[2])) << "the camera must move";
}

/// IEC 61966-2-1, the code of a linear value before rounding.
double srgb(double linear) {
    const double v = std::clamp(linear, 0.0, 1.0);
    return 255 * (v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055);
}

TEST_F(SyntheticSourceTest, EncodesColorDepthAndLabelsAsASequenceHoldsThem) {
    Scene scene = sensor::load_scene("cubes");
    scene.lights[0].intensity *= 3;  // so that some pixels are clipped
    const Recorded got = record(device(), scene, 1).front();
    const Rendered rendered = render(scene);
    size_t clipped = 0;
    for (size_t i = 0; i < colors(got).size(); ++i) {
        const glm::vec4 radiance = rendered.radiance.pixels()[i];
        for (int c = 0; c < 3; ++c) {
            // Half a code of rounding, and what a device's pow may be off by.
            ASSERT_NEAR(colors(got)[i][c], srgb(radiance[c]), 0.51);
            clipped += radiance[c] > 1;
        }
        ASSERT_NEAR(depths(got)[i], 1000.0 * rendered.depth_m.pixels()[i], 0.501);
        ASSERT_EQ(got.labels.pixels()[i], rendered.object_id.pixels()[i]);
    }
    EXPECT_GT(clipped, 100u);
}

TEST_F(SyntheticSourceTest, DepthBeyondSixteenBitsIsNoReading) {
    Scene scene = sensor::load_scene("cubes");
    scene.camera = scaled_to(scene.camera, {32, 24});
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
        const uint16_t id = recorded.labels.pixels()[i];
        if (id == 0) continue;
        const sensor::SrgbPixel color = colors(recorded)[i];
        ++pixels, ++a.pixels_of[id];
        a.clipped += std::max({color.r, color.g, color.b}) == 255;
        a.mean_green += color.g;
    }
    a.clipped /= pixels;
    a.mean_green /= pixels;
    return a;
}

/// The cubes in 15 frames over the camera path's whole minute.
Scene slow_cubes() {
    Scene scene = sensor::load_scene("cubes");
    scene.fps = 0.25;
    return scene;
}

TEST_F(SyntheticSourceTest, CubesAreWellExposedAndAllVisible) {
    const Scene scene = slow_cubes();
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
    const Scene scene = slow_cubes();
    Scene diffuse = scene;
    for (auto& object : diffuse.objects) object.material.ks = glm::dvec3(0);
    const auto glossy = record(device(), scene, 15), dull = record(device(), diffuse, 15);
    std::set<uint16_t> shown;
    for (size_t f = 0; f < glossy.size(); ++f) {
        for (size_t i = 0; i < colors(glossy[f]).size(); ++i)
            if (colors(glossy[f])[i].g > colors(dull[f])[i].g + 40) shown.insert(glossy[f].labels.pixels()[i]);
    }
    EXPECT_GE(shown.size(), scene.objects.size() * 2 / 3);
}

}  // namespace
}  // namespace patina
