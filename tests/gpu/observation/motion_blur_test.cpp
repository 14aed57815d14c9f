#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <glm/gtc/matrix_transform.hpp>

#include "engine/core/shader_camera.h"
#include "tests/gpu/gpu_test.h"
#include "tests/gpu/observation/observation_rig.h"

// Observations stay out where motion smears the picture.

namespace patina::motion_blur_test {
namespace {

const Intrinsics kCamera{{160, 120}, 150, 150, 79.5, 59.5, {}};
const RigidTransform kPose{1.0};
constexpr double kWallM = 1.003;

class MotionBlur : public GpuTest {
  protected:
    /// The records of a wall that faces the camera at kPose, whose shutter was open for a share of the time since it
    /// was at `before`.
    ObservationContent seen_after(const RigidTransform& before, float shutter_share, uint32_t stride_px = 1) {
        ObservationSettings settings;
        settings.stride_px = stride_px;
        settings.max_blur_px = 1;
        settings.smeared_observations = 0;
        ObservationRig rig(device(), runner(), {}, settings);
        RigFrame frame = frame_at(kPose);
        frame.motion = {make_camera(kCamera, before).camera_from_world, shutter_share};
        rig.fuse(frame);
        rig.collect(frame);
        return rig.content();
    }

    /// A wall across the z axis.
    static RigFrame frame_at(const RigidTransform& pose) {
        return {kCamera,
                pose,
                Image<float>(kCamera.extent, static_cast<float>(kWallM)),
                {kCamera, pose, Image<glm::vec4>(kCamera.extent, glm::vec4(0.5, 0.5, 0.5, 1))}};
    }

    static double observed_share(const ObservationContent& content) {
        size_t observed = 0;
        for (const auto& [at, record] : content) observed += record.count() > 0;
        return static_cast<double>(observed) / static_cast<double>(content.size());
    }
};

TEST_F(MotionBlur, SidewaysMotionCountsByFocalLengthOverDepthTimesTheShareOfTheShutter) {
    const RigidTransform before = glm::translate(kPose, glm::dvec3(0.02, 0, 0));  // 150 * 0.02 / 1.003: 2.99 pixels
    const double sharp = observed_share(seen_after(before, 0));
    EXPECT_GT(sharp, 0.8);
    EXPECT_EQ(observed_share(seen_after(before, 0.33f)), sharp);
    EXPECT_EQ(observed_share(seen_after(before, 0.34f)), 0);
    const RigidTransform turned_away = glm::rotate(kPose, glm::radians(170.0), glm::dvec3(0, 1, 0));
    EXPECT_EQ(observed_share(seen_after(turned_away, 0.01f)), 0) << "what was behind the camera";
}

TEST_F(MotionBlur, VoxelsOfFewObservationsTakeSmearedOnes) {
    ObservationSettings settings;
    settings.stride_px = 1;
    settings.max_blur_px = 1;
    settings.smeared_observations = 2;
    ObservationRig rig(device(), runner(), {}, settings);
    const auto pose = [](int step) { return glm::translate(kPose, glm::dvec3(0.04 * step, 0, 0)); };  // 2 degrees
    const std::vector<std::pair<bool, uint32_t>> smeared_then_most{
        {true, 1}, {true, 2}, {true, 2}, {false, 3}, {true, 3}};
    for (int i = 0; i < static_cast<int>(smeared_then_most.size()); ++i) {
        const auto [smeared, most] = smeared_then_most[static_cast<size_t>(i)];
        RigFrame frame = frame_at(pose(i));
        frame.motion = {make_camera(kCamera, pose(i - 1)).camera_from_world, smeared ? 1.0f : 0.0f};
        rig.fuse(frame);
        rig.collect(frame);
        uint32_t largest = 0;
        for (const auto& [at, record] : rig.content()) largest = std::max(largest, record.count());
        EXPECT_EQ(largest, most) << i;
    }
}

TEST_F(MotionBlur, ARestingCameraLooksAtAQuarterOfThePixels) {
    const glm::dvec3 up(0, 1, 0);
    const double half_pixel = 0.5 / kCamera.fx;
    const size_t moving = seen_after(glm::translate(kPose, 1.1 * half_pixel * up), 0, 4).size();
    EXPECT_EQ(seen_after(glm::rotate(kPose, 1.1 * half_pixel, up), 0, 4).size(), moving);
    for (const RigidTransform& rest :
         {kPose, glm::translate(kPose, 0.9 * half_pixel * up), glm::rotate(kPose, 0.9 * half_pixel, up)}) {
        const auto looked = static_cast<double>(seen_after(rest, 0, 4).size());
        EXPECT_NEAR(looked / static_cast<double>(moving), 0.25, 0.05);
    }
}

TEST_F(MotionBlur, RotationAboutTheAxisLeavesTheMiddleSharp) {
    const double turn = glm::radians(2.0);
    const ObservationContent content = seen_after(glm::rotate(kPose, turn, glm::dvec3(0, 0, 1)), 0.5f);
    const double limit_px = 1 / (0.5 * 2 * std::sin(turn / 2));  // where the chord, half of it, is one pixel long
    size_t inside = 0, outside = 0;
    for (const auto& [at, record] : content) {
        const glm::dvec2 center_m = (glm::dvec2(at[0], at[1]) + 0.5) * 0.02;
        const double from_center_px = glm::length(center_m) * kCamera.fx / kWallM;
        if (std::abs(from_center_px - limit_px) < 0.5 || std::abs(center_m.y) > 0.35) continue;
        (from_center_px < limit_px ? inside : outside) += 1;
        if (from_center_px < limit_px) {
            EXPECT_EQ(record.count(), 1u) << at[0] << ' ' << at[1];
        } else {
            EXPECT_EQ(record.count(), 0u) << at[0] << ' ' << at[1];
        }
    }
    EXPECT_GT(inside, 500u);
    EXPECT_GT(outside, 100u);
}

}  // namespace
}  // namespace patina::motion_blur_test
