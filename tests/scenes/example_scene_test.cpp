#include "scenes/description/example_scene.h"

#include <cstring>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace patina::scenes::example_scene_test {
namespace {

bool same(const ExampleScene& a, const ExampleScene& b) {
    return std::memcmp(&a.scene, &b.scene, sizeof(a.scene)) == 0 && a.lamps.size() == b.lamps.size() &&
           std::memcmp(a.materials.data(), b.materials.data(), sizeof(a.materials)) == 0 &&
           std::memcmp(a.voxels.data(), b.voxels.data(), sizeof(a.voxels)) == 0 && a.views == b.views;
}

double degrees_between(glm::vec4 a, glm::vec4 b) {
    return glm::degrees(std::acos(std::min(glm::dot(glm::dvec3(a), glm::dvec3(b)), 1.0)));
}

std::vector<ExampleScene> scenes(uint64_t seed, uint64_t count) {
    std::vector<ExampleScene> all;
    for (uint64_t i = 0; i < count; ++i) all.push_back(draw_example_scene(seed, i));
    return all;
}

TEST(ExampleScene, FollowsFromSeedAndNumber) {
    EXPECT_TRUE(same(draw_example_scene(3, 7), draw_example_scene(3, 7)));
    EXPECT_FALSE(same(draw_example_scene(3, 7), draw_example_scene(3, 8)));
    EXPECT_FALSE(same(draw_example_scene(3, 7), draw_example_scene(4, 7)));
}

TEST(ExampleScene, MaterialsAreWhatTheDocumentationSays) {
    int matte = 0, small = 0;
    constexpr int kCount = 2000;
    for (uint64_t i = 0; i < kCount; ++i) {
        const gpu::WardMaterial material = draw_example_material(1, i, 0);
        const glm::vec3 kd(material.kd_weight), ks(material.ks_alpha), sum = kd + ks;
        EXPECT_GE(std::min({kd.x, kd.y, kd.z, ks.x, ks.y, ks.z}), 0);
        EXPECT_LE(std::max({sum.x, sum.y, sum.z}), 0.9501f);
        EXPECT_LE(std::max({ks.x, ks.y, ks.z}), 0.5f);
        EXPECT_GE(material.ks_alpha.w, 0.03f);
        EXPECT_LE(material.ks_alpha.w, 0.5f);
        matte += ks == glm::vec3(0) ? 1 : 0;
        small += ks.g < 0.15f ? 1 : 0;
    }
    EXPECT_NEAR(matte, 0.1 * kCount, 0.03 * kCount);
    EXPECT_GT(small, 0.6 * kCount);
}

TEST(ExampleScene, LightsAndVoxelsAreWhatTheDocumentationSays) {
    constexpr uint64_t kCount = 400;
    int lit_by_lamps = 0, foreign = 0;
    for (const ExampleScene& scene : scenes(2, kCount)) {
        lit_by_lamps += scene.scene.windows == 0 ? 1 : 0;
        EXPECT_GT(scene.scene.windows + scene.scene.lamps, 0u);
        EXPECT_LE(scene.scene.lamps, 6u);
        EXPECT_GE(scene.scene.views, 10u);
        EXPECT_LE(scene.scene.views, gpu::kExampleViews);
        EXPECT_LE(scene.normal_error_degrees, 6);
        for (const gpu::ExampleVoxel& voxel : scene.voxels) {
            foreign += voxel.material != 0 ? 1 : 0;
            EXPECT_NEAR(glm::length(glm::vec3(voxel.normal)), 1, 1e-5);
            EXPECT_LE(degrees_between(voxel.normal, voxel.stored_normal), scene.normal_error_degrees + 0.05);
        }
    }
    EXPECT_NEAR(lit_by_lamps, 0.5 * kCount, 0.1 * kCount);
    EXPECT_NEAR(foreign, 0.05 * kCount * gpu::kExampleVoxels, 0.01 * kCount * gpu::kExampleVoxels);
}

TEST(ExampleScene, NearlyAllVoxelsAreFacedByEnoughViews) {
    size_t enough = 0;
    const std::vector<ExampleScene> all = scenes(5, 200);
    for (const ExampleScene& scene : all) {
        for (const gpu::ExampleVoxel& voxel : scene.voxels) {
            uint32_t faced = 0;
            for (uint32_t i = 0; i < scene.scene.views; ++i) {
                const glm::vec3 toward = glm::vec3(scene.views[i]) - glm::vec3(voxel.point_m);
                faced += glm::dot(glm::vec3(voxel.normal), glm::normalize(toward)) > 0.1736f ? 1 : 0;
            }
            enough += faced >= gpu::kLeastHemiObservations ? 1 : 0;
        }
    }
    EXPECT_GT(static_cast<double>(enough), 0.97 * static_cast<double>(all.size() * gpu::kExampleVoxels));
}

}  // namespace
}  // namespace patina::scenes::example_scene_test
