#include "tools/synth/example_renderer.h"

#include <cmath>
#include <numbers>

#include <glm/gtc/packing.hpp>

#include "tests/gpu/gpu_test.h"
#include "tests/reference/shading/ward.h"

namespace patina::tools::example_renderer_test {
namespace {

using scenes::ExampleScene;

constexpr uint32_t kScenes = 3, kVoxels = gpu::kExampleVoxels;

double linear_of(double code) {
    const double v = code / 255;
    return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}
/// A linear value after 8 bits of sRGB.
double quantised(double value) {
    const double v = std::clamp(value, 0.0, 1.0);
    return linear_of(std::round(255 * (v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055)));
}

class ExampleRendererTest : public GpuTest {
  protected:
    struct Result {
        std::vector<uint16_t> halves;
        std::vector<uint32_t> drawn;
        std::vector<gpu::ExampleReading> readings;
        std::vector<float> exposures;

        const gpu::ExampleReading& at(uint32_t view, uint32_t scene, uint32_t voxel) const {
            return readings[(size_t{view} * kScenes + scene) * kVoxels + voxel];
        }
    };

    static Result render(const std::vector<ExampleScene>& scenes, uint64_t seed = 1) {
        ExampleRenderer renderer(device(), kScenes, HemisphereMap::kParabolic, true);
        const RenderedExamples rendered = renderer.submit(seed, 0, scenes);
        renderer.wait();
        return {rendered.halves.as<uint16_t>(), rendered.drawn.as<uint32_t>(),
                rendered.readings.as<gpu::ExampleReading>(), rendered.exposures.as<float>()};
    }

    /// Scenes lit by lamps or by an environment alone, without noise; all voxels are of the first material.
    static std::vector<ExampleScene> clean_scenes(bool lamps) {
        std::vector<ExampleScene> scenes;
        for (uint64_t i = 0; scenes.size() < kScenes; ++i) {
            ExampleScene scene = scenes::draw_example_scene(9, i);
            if ((scene.scene.windows == 0) != lamps) continue;
            scene.scene.read = scene.scene.shot = 0;
            scene.scene.ground.w = 0;
            if (lamps) scene.scene.sky = {0, 0, 0, scene.scene.sky.w};
            if (lamps) scene.scene.ground = glm::vec4(0);
            if (!lamps) scene.scene.lamps = 0;
            for (gpu::ExampleVoxel& voxel : scene.voxels) {
                voxel.material = 0;
                voxel.stored_normal = voxel.normal;
            }
            scenes.push_back(scene);
        }
        return scenes;
    }

    static reference::Ward material_of(const ExampleScene& scene, const gpu::ExampleVoxel& voxel) {
        const gpu::WardMaterial& material = scene.materials[voxel.material];
        return {glm::dvec3(material.kd_weight) * double{voxel.point_m.w}, glm::dvec3(material.ks_alpha),
                double{material.ks_alpha.w}};
    }

    static glm::dvec3 under_lamps(const ExampleScene& scene, const gpu::ExampleVoxel& voxel, glm::dvec3 to_viewer) {
        glm::dvec3 sum(0);
        for (uint32_t i = 0; i < scene.scene.lamps; ++i) {
            if ((voxel.shadow >> i & 1u) != 0) continue;
            const glm::dvec3 way = glm::dvec3(scene.lamps[i].position_m) - glm::dvec3(voxel.point_m);
            const glm::dvec3 to_light = glm::normalize(way), normal(voxel.normal);
            sum += reference::ward(material_of(scene, voxel), normal, to_light, to_viewer) *
                   glm::dvec3(scene.lamps[i].intensity) *
                   (std::max(glm::dot(normal, to_light), 0.0) / glm::dot(way, way));
        }
        return sum;
    }

    static glm::dvec3 from_afar(const ExampleScene& scene, glm::dvec3 direction) {
        glm::dvec3 sum = glm::mix(glm::dvec3(scene.scene.ground), glm::dvec3(scene.scene.sky), 0.5 - direction.y / 2);
        for (uint32_t i = 0; i < scene.scene.windows; ++i) {
            const gpu::ExampleWindow& window = scene.windows[i];
            sum += glm::dvec3(window.radiance) * glm::smoothstep(double{window.direction.w}, double{window.radiance.w},
                                                                 glm::dot(direction, glm::dvec3(window.direction)));
        }
        return sum;
    }

    /// By a grid over all directions.
    static glm::dvec3 under_environment(const ExampleScene& scene, const gpu::ExampleVoxel& voxel,
                                        glm::dvec3 to_viewer) {
        constexpr int kRings = 180, kSectors = 360;
        glm::dvec3 sum(0);
        const reference::Ward material = material_of(scene, voxel);
        for (int ring = 0; ring < kRings; ++ring) {
            const double theta = (ring + 0.5) * std::numbers::pi / kRings;
            for (int sector = 0; sector < kSectors; ++sector) {
                const double phi = (sector + 0.5) * 2 * std::numbers::pi / kSectors;
                const glm::dvec3 d(std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi));
                const double cosine = glm::dot(d, glm::dvec3(voxel.normal));
                if (cosine <= 0) continue;
                sum += reference::ward(material, glm::dvec3(voxel.normal), d, to_viewer) * from_afar(scene, d) *
                       (cosine * std::sin(theta));
            }
        }
        return sum * (2 * std::numbers::pi * std::numbers::pi / kRings / kSectors);
    }
};

TEST_F(ExampleRendererTest, TheSameSeedGivesTheSameImages) {
    std::vector<ExampleScene> scenes;
    for (uint64_t i = 0; i < kScenes; ++i) scenes.push_back(scenes::draw_example_scene(4, i));
    const Result one = render(scenes, 4), again = render(scenes, 4), other = render(scenes, 5);
    EXPECT_EQ(one.halves, again.halves);
    EXPECT_EQ(one.drawn, again.drawn);
    EXPECT_NE(one.halves, other.halves);
}

TEST_F(ExampleRendererTest, LampsShineAsWardSays) {
    const std::vector<ExampleScene> scenes = clean_scenes(true);
    const Result result = render(scenes);
    size_t compared = 0, dark = 0;
    for (uint32_t s = 0; s < kScenes; ++s) {
        for (uint32_t v = 0; v < kVoxels; ++v) {
            const gpu::ExampleVoxel& voxel = scenes[s].voxels[v];
            for (uint32_t k = 0; k < gpu::kExampleViews; ++k) {
                const glm::dvec3 way = glm::dvec3(scenes[s].views[k]) - glm::dvec3(voxel.point_m);
                const double cosine = glm::dot(glm::normalize(way), glm::dvec3(voxel.normal));
                const gpu::ExampleReading& reading = result.at(k, s, v);
                const bool seen = k < scenes[s].scene.views && cosine >= std::cos(glm::radians(80.0));
                if (std::abs(cosine - std::cos(glm::radians(80.0))) > 1e-4) {
                    ASSERT_EQ(reading.to_viewer.w == 1, seen);
                }
                if (reading.to_viewer.w == 0) continue;
                const glm::dvec3 value =
                    under_lamps(scenes[s], voxel, glm::normalize(way)) * double{result.exposures[s]};
                for (int c = 0; c < 3; ++c) {
                    // fp32 may land on the neighbouring code.
                    EXPECT_NEAR(reading.rgb[c], quantised(value[c]), 0.0095) << s << ", " << v << ", view " << k;
                    if (std::abs(value[c] - 1) > 0.01) {
                        EXPECT_EQ((static_cast<uint32_t>(reading.rgb.w) >> c & 1u) != 0, value[c] > 1);
                    }
                }
                dark += value.g < 1e-6 ? 1 : 0;
                ++compared;
            }
        }
    }
    EXPECT_GT(compared, 500u);
    EXPECT_LT(dark, compared / 2);
}

TEST_F(ExampleRendererTest, TheSkyShinesAsAnIntegralSays) {
    std::vector<ExampleScene> scenes = clean_scenes(false);
    for (ExampleScene& scene : scenes) {
        scene.scene.sky.w = 0.4f;  // nothing is clipped
        // Broad enough for the reference's grid.
        scene.materials[0] = {glm::vec4(0.2f, 0.2f, 0.2f, 1), glm::vec4(0.3f, 0.3f, 0.3f, 0.25f)};
        scene.materials[1] = scene.materials[2] = scene.materials[3] = scene.materials[0];
    }
    const Result result = render(scenes);
    for (uint32_t s = 0; s < kScenes; ++s) {
        glm::dvec3 sum(0), want(0);
        for (uint32_t v = 0; v < kVoxels; v += 2) {
            for (uint32_t k = v % 5; k < scenes[s].scene.views; k += 9) {
                const gpu::ExampleReading& reading = result.at(k, s, v);
                if (reading.to_viewer.w == 0 || reading.rgb.w != 0) continue;
                sum += glm::dvec3(reading.rgb);
                want += under_environment(scenes[s], scenes[s].voxels[v], glm::dvec3(reading.to_viewer)) *
                        double{result.exposures[s]};
            }
        }
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(sum[c] / want[c], 1, 0.03) << s;
    }
}

TEST_F(ExampleRendererTest, AQuantileOfWhatIsSeenIsAsBrightAsAskedFor) {
    std::vector<ExampleScene> scenes = clean_scenes(true);
    for (uint32_t s = 0; s < kScenes; ++s) {
        scenes[s].scene.sky.w = 0.5f + 0.1f * static_cast<float>(s);
        for (gpu::WardMaterial& material : scenes[s].materials) {
            material = {glm::vec4(0.5f, 0.3f, 0.2f, 1), glm::vec4(0, 0, 0, 0.2f)};
        }
    }
    const Result result = render(scenes);
    for (uint32_t s = 0; s < kScenes; ++s) {
        std::vector<float> red;
        for (uint32_t k = 0; k < scenes[s].scene.views; ++k) {
            for (uint32_t v = 0; v < kVoxels; ++v) {
                if (result.at(k, s, v).to_viewer.w > 0) red.push_back(result.at(k, s, v).rgb.r);
            }
        }
        std::ranges::sort(red);
        const double share = 1.0 / static_cast<double>(red.size()) *
                             static_cast<double>(std::ranges::lower_bound(red, scenes[s].scene.sky.w) - red.begin());
        EXPECT_NEAR(share, 0.95, 0.05) << s;
    }
}

TEST_F(ExampleRendererTest, ImagesShowWhatWasReadOfTheirVoxels) {
    std::vector<ExampleScene> scenes = clean_scenes(true);
    for (ExampleScene& scene : scenes) scene.scene.views = 20;
    const Result result = render(scenes);
    constexpr uint32_t kPixels = gpu::kHemiPixels;
    for (uint32_t image = 0; image < kScenes * gpu::kHemiSamples; ++image) {
        const uint32_t s = image / gpu::kHemiSamples, record = result.drawn[image];
        ASSERT_EQ(record / kVoxels, s);
        for (uint32_t pixel = 0; pixel < kPixels; pixel += 7) {
            const size_t first = size_t{s} * gpu::kExampleHalves + ((image % gpu::kHemiSamples) * kPixels + pixel) * 3;
            const float green = glm::unpackHalf1x16(result.halves[first + 1]);
            float low = 2, high = -1, nearest = 2;
            for (uint32_t k = 0; k < 20; ++k) {
                const gpu::ExampleReading& reading = result.at(k, s, record % kVoxels);
                if (reading.to_viewer.w == 0) continue;
                low = std::min(low, reading.rgb.g);
                high = std::max(high, reading.rgb.g);
                nearest = std::min(nearest, std::abs(reading.rgb.g - green));
            }
            // Readings from the same direction are averaged, and colours rounded to 9 bits of the brightest channel.
            EXPECT_GE(green, low - 0.002f);
            EXPECT_LE(green, high + 0.002f);
            EXPECT_LT(nearest, 0.05f);
        }
    }
}

}  // namespace
}  // namespace patina::tools::example_renderer_test
