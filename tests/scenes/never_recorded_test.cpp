#include "scenes/description/never_recorded.h"

#include <cmath>

#include <gtest/gtest.h>

#include "engine/core/error.h"
#include "scenes/description/clearance.h"
#include "scenes/files/scene_file.h"

namespace patina::scenes::never_recorded_test {
namespace {

constexpr uint32_t kViews = 24;
constexpr double kDuration_s = 20;

TEST(NeverRecorded, ViewsAreBesideThePathAndKeepClear) {
    for (const char* name : {"office", "bunnies", "cubes"}) {
        SyntheticScene scene = load_scene(name, {});
        scene.recording.noise.depth_constant_m = 0.01;
        const SyntheticScene novel = with_novel_views(scene, kViews, kDuration_s);
        Clearance clearance(scene.objects);
        for (const Light& light : scene.lights) clearance.add(light);
        uint32_t far = 0, above = 0;
        for (uint32_t i = 0; i < kViews; ++i) {
            const RigidTransform recorded = world_from_camera(scene.path, kDuration_s * (i + 0.5) / kViews);
            const RigidTransform view = world_from_camera(novel.path, i / novel.fps);
            const glm::dvec3 at_m(view[3]), was_m(recorded[3]);
            EXPECT_GE(clearance.at(at_m), 0.19) << name << i;
            EXPECT_LT(glm::distance(at_m, was_m), 0.66) << name << i;
            far += glm::distance(at_m, was_m) > 0.4;
            above += at_m.y < was_m.y;
            const glm::dvec3 ahead_m = was_m + 2.0 * glm::dvec3(recorded[2]);
            EXPECT_LT(glm::distance(glm::normalize(ahead_m - at_m), glm::dvec3(view[2])), 1e-6) << name << i;
        }
        EXPECT_GT(far, kViews / 2) << name;
        EXPECT_GT(above, 4u) << name;
        EXPECT_LT(above, kViews - 4) << name;
        EXPECT_EQ(novel.recording.noise.depth_constant_m, 0) << name;
        EXPECT_EQ(novel.lights.size(), scene.lights.size()) << name;
    }
    EXPECT_THROW(with_novel_views(load_scene("cubes", {}), 1, 1), Error);
}

TEST(NeverRecorded, LampsAreElsewhereAndGiveAsMuchLight) {
    const SyntheticScene scene = load_scene("bunnies", {}), other = with_other_light(scene);
    ASSERT_EQ(other.lights.size(), scene.lights.size());
    double before = 0, after = 0, moved_m = 0;
    const glm::dvec3 luminance(0.2126, 0.7152, 0.0722);
    for (size_t i = 0; i < scene.lights.size(); ++i) {
        before += glm::dot(scene.lights[i].intensity, luminance);
        after += glm::dot(other.lights[i].intensity, luminance);
        moved_m += glm::distance(scene.lights[i].position_m, other.lights[i].position_m);
        EXPECT_NE(scene.lights[i].intensity, other.lights[i].intensity);
    }
    EXPECT_NEAR(after, before, 1e-9 * before);
    EXPECT_GT(moved_m, 0.3 * static_cast<double>(scene.lights.size()));
    EXPECT_EQ(world_from_camera(scene.path, 1), world_from_camera(other.path, 1));
}

}  // namespace
}  // namespace patina::scenes::never_recorded_test
