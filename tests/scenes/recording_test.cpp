#include <cmath>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <gmock/gmock.h>

#include "scenes/description/lighting_sequence.h"
#include "scenes/description/pose_noise.h"

namespace patina::scenes::recording_test {
namespace {

/// Root mean square of one component of many vectors.
double rms(const std::vector<glm::dvec3>& vectors, int axis) {
    double sum = 0;
    for (const glm::dvec3& v : vectors) sum += v[axis] * v[axis];
    return std::sqrt(sum / static_cast<double>(vectors.size()));
}

TEST(PoseNoise, HasTheSetDeviationsPerAxisInTheCamerasFrame) {
    const RigidTransform pose = placed({1, -2, 3}, {1, 2, 3}, 2.5);
    SensorNoise noise;
    noise.pose_translation_m = 0.02;
    noise.pose_rotation_rad = 0.005;
    std::vector<glm::dvec3> moved, turned;
    glm::dvec3 mean(0);
    for (uint32_t frame = 0; frame < 4000; ++frame) {
        const RigidTransform error = rigid_inverse(pose) * with_pose_noise(pose, noise, {7, frame});
        EXPECT_LT(rotation_defect(error), 1e-12);
        moved.emplace_back(error[3]);
        const glm::dquat q = glm::quat_cast(glm::dmat3(error));
        turned.push_back(2.0 * glm::dvec3(q.x, q.y, q.z));  // the rotation vector of a small turn
        mean += moved.back() / 4000.0;
    }
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(rms(moved, axis), 0.02, 0.001) << axis;
        EXPECT_NEAR(rms(turned, axis), 0.005, 0.00025) << axis;
        EXPECT_NEAR(mean[axis], 0, 0.0015) << axis;
    }
}

TEST(PoseNoise, WithoutNoiseIsTheTruePose) {
    const RigidTransform pose = placed({1, -2, 3}, {1, 2, 3}, 2.5);
    EXPECT_EQ(with_pose_noise(pose, {}, {1, 2}), pose);
}

TEST(PoseNoise, TheKeyAloneDecides) {
    SensorNoise noise;
    noise.pose_translation_m = 0.02;
    const RigidTransform pose(1.0);
    const auto disturbed = [&](NoiseKey key) { return with_pose_noise(pose, noise, key); };
    EXPECT_EQ(disturbed({1, 2}), disturbed({1, 2}));
    EXPECT_NE(disturbed({1, 2}), disturbed({1, 3}));
    EXPECT_NE(disturbed({1, 2}), disturbed({2, 2}));
    EXPECT_NE(disturbed({1, 2}), disturbed({1 + (uint64_t{1} << 32), 2}));
}

SyntheticScene lit_scene() {
    SyntheticScene scene;
    scene.lights = {{{0, -2, 0}, {3, 2, 1}, 0.1}, {{1, -2, 0}, {1, 9, 1}, 0.2}, {{2, -2, 0}, {99, 99, 99}, 0}};
    scene.lighting = LightingRecording{WaypointPath{{{{0, -1, 0}, {0, -1, 1}}, {{1, -1, 0}, {1, -1, 1}}}, 5}, 42};
    scene.recording.seed = 3;
    return scene;
}

TEST(LightingSequence, TheBrightestVisibleLampIsBelowClipping) {
    const auto sequence = lighting_sequence(lit_scene());
    ASSERT_TRUE(sequence);
    EXPECT_EQ(sequence->frames, 42u);
    EXPECT_TRUE(std::holds_alternative<WaypointPath>(sequence->scene.path));
    EXPECT_NE(sequence->scene.recording.seed, 3u) << "noise of its own";
    // 3 / (pi 0.1^2) = 95.5 is above 9 / (pi 0.2^2) = 71.6; the point light is not seen.
    EXPECT_NEAR(sequence->exposure * emitted_radiance(sequence->scene.lights[0]).r, 0.8, 1e-12);
}

TEST(LightingSequence, IsNeverBrighterThanTheMainSequence) {
    SyntheticScene scene = lit_scene();
    for (Light& light : scene.lights) light.intensity = glm::dvec3(0.001);
    EXPECT_EQ(lighting_sequence(scene)->exposure, 1);
}

TEST(LightingSequence, NeedsAPathAndALampThatIsSeen) {
    SyntheticScene scene = lit_scene();
    scene.lighting.reset();
    EXPECT_FALSE(lighting_sequence(scene));
    scene = lit_scene();
    for (Light& light : scene.lights) light.radius_m = 0;
    EXPECT_FALSE(lighting_sequence(scene));
    scene = lit_scene();
    for (Light& light : scene.lights) light.intensity = glm::dvec3(0);
    EXPECT_FALSE(lighting_sequence(scene));
}

}  // namespace
}  // namespace patina::scenes::recording_test
