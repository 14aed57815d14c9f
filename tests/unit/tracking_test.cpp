#include "shared/tracking/tracking.h"

#include <cmath>

#include <glm/gtc/matrix_transform.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "passes/tracking/judge_motion.h"
#include "passes/tracking/motion_model.h"
#include "tests/reference/scenes/analytic_scene.h"
#include "tests/reference/tracking/track.h"

namespace patina::tracking_test {
namespace {

using ::testing::HasSubstr;

RigidTransform moved(glm::dvec3 way_m, double degrees) {
    RigidTransform pose = glm::rotate(RigidTransform(1.0), glm::radians(degrees), glm::dvec3(0, 1, 0));
    pose[3] = glm::dvec4(way_m, 1);
    return pose;
}

double distance(const RigidTransform& a, const RigidTransform& b) {
    double most = 0;
    for (int column = 0; column < 4; ++column) most = std::max(most, glm::length(a[column] - b[column]));
    return most;
}

TEST(MotionModel, ASteadyMotionGoesOn) {
    MotionModel model(1);
    const RigidTransform step = moved({0.01, 0, 0.02}, 1);
    model.jump_to(RigidTransform(1.0), {1.0});
    model.note(step, {1.1});
    EXPECT_LT(distance(model.expected({1.2}).front(), step * step), 1e-9);
    // The camera may as well stand still.
    EXPECT_EQ(model.expected({1.2}).back(), step);
    // A frame left out: twice the time, twice the way.
    EXPECT_NEAR(glm::length(glm::dvec3((rigid_inverse(step) * model.expected({1.3}).front())[3])),
                2 * glm::length(glm::dvec3(step[3])), 1e-9);
}

TEST(MotionModel, AMotionIsDampedButNotAfterALoss) {
    MotionModel model(0.5);
    model.jump_to(RigidTransform(1.0), {0});
    model.note(moved({0.1, 0, 0}, 0), {0.1});
    EXPECT_NEAR(model.expected({0.2}).front()[3].x, 0.15, 1e-12);
    model.note_loss();
    EXPECT_NEAR(model.expected({0.3}).front()[3].x, 0.3, 1e-12);
}

TEST(MotionModel, APriorLeadsInItsOwnWorld) {
    MotionModel model(1);
    const RigidTransform other_world = moved({5, 2, 1}, 70), step = moved({0.02, 0.01, 0}, 2);
    model.jump_to(moved({1, 0, 0}, 10), {0, other_world});
    const auto expected = model.expected({0.1, other_world * step});
    EXPECT_LT(distance(expected.front(), moved({1, 0, 0}, 10) * step), 1e-9);
    EXPECT_EQ(model.expected({0.1}).size(), 1u);
}

/// A search that went well.
gpu::TrackState good_state() {
    gpu::TrackState state{};
    state.rotation = glm::vec4(0, 0, 0, 1);
    state.readings = 10000;
    state.pairs = 9000;
    state.sigmas = 1;
    state.solutions = 8;
    state.eigenvalues_low = glm::vec4(0.1f);
    state.mean_depth_m = 2;
    state.gain = 1;
    return state;
}

TrackingReport judged(const gpu::TrackState& state) { return judge_motion(state, RigidTransform(1.0), {}); }

TEST(JudgeMotion, AGoodSearchTracks) {
    const TrackingReport report = judged(good_state());
    EXPECT_EQ(report.state, TrackingState::kTracking);
    EXPECT_EQ(report.reason, "");
    EXPECT_NEAR(report.share, 0.9, 1e-6);
}

TEST(JudgeMotion, EachBoundHasItsStateAndReason) {
    struct Case {
        void (*spoil)(gpu::TrackState&);
        TrackingState state;
        const char* reason;
    };
    const Case cases[] = {
        {[](gpu::TrackState& s) { s.pairs = 499; }, TrackingState::kLost, "only 499 of 10000 readings"},
        {[](gpu::TrackState& s) { s.readings = s.pairs = 0; }, TrackingState::kLost, "only 0 of 0"},
        {[](gpu::TrackState& s) { s.solutions = 0; }, TrackingState::kLost, "readings lie on the model"},
        {[](gpu::TrackState& s) { s.pairs = 1900; }, TrackingState::kLost, "19 % of the readings"},
        {[](gpu::TrackState& s) { s.pairs = 3900; }, TrackingState::kWeak, "39 % of the readings"},
        {[](gpu::TrackState& s) { s.sigmas = 3; }, TrackingState::kWeak, "3 sigmas off"},
        {[](gpu::TrackState& s) { s.sigmas = 4.5; }, TrackingState::kLost, "4.5 sigmas off"},
        {[](gpu::TrackState& s) { s.held = 3; }, TrackingState::kWeak, "3 directions of motion open"},
        {[](gpu::TrackState& s) { s.step_m = 0.004f; }, TrackingState::kWeak, "did not settle"},
        {[](gpu::TrackState& s) { s.step_rad = 0.004f; }, TrackingState::kWeak, "did not settle"},
        {[](gpu::TrackState& s) { s.translation_m.x = 0.5f; }, TrackingState::kLost, "0.5 m from where"},
        {[](gpu::TrackState& s) { s.rotation = glm::vec4(0, 0.3f, 0, 0.954f); }, TrackingState::kLost, "turned by"},
        {[](gpu::TrackState& s) { s.translation_m.x = NAN; }, TrackingState::kLost, "lie on the model"},
    };
    for (const Case& c : cases) {
        gpu::TrackState state = good_state();
        c.spoil(state);
        const TrackingReport report = judged(state);
        EXPECT_EQ(report.state, c.state) << c.reason;
        EXPECT_THAT(report.reason, HasSubstr(c.reason));
    }
}

TEST(JudgeMotion, TheWorstReasonIsTold) {
    gpu::TrackState state = good_state();
    state.held = 1;
    state.pairs = 1000;
    EXPECT_THAT(judged(state).reason, HasSubstr("10 %"));
}

TEST(TrackReference, FindsTheMotionBeforeACornerOfARoom) {
    const auto floor = reference::half_space({0, -1, 0}, -0.9), left = reference::half_space({1, 0, 0}, -0.8),
               back = reference::half_space({0, 0, -1}, -2.2);
    const reference::DistanceField corner = [=](glm::dvec3 p) { return std::min({floor(p), left(p), back(p)}); };
    const Intrinsics camera{{64, 48}, 50, 50, 31.5, 23.5, {}};
    const RigidTransform world_from_model = reference::look_at({0.05, -0.1, -0.3}, {0, 0.1, 2}),
                         motion = moved({0.01, -0.005, 0.012}, 0.5);
    const auto seen = reference::render_depth(corner, camera, world_from_model * motion, 6);
    Image<reference::TrackReading> frame(camera.extent);
    Image<reference::TrackSurface> model(camera.extent);
    const auto depth = reference::render_depth(corner, camera, world_from_model, 6);
    for (uint32_t y = 0; y < camera.extent.height; ++y) {
        for (uint32_t x = 0; x < camera.extent.width; ++x) {
            frame.at(x, y).depth_m = seen.at(x, y);
            const double z = depth.at(x, y);
            const glm::dvec4 local(z * (x - camera.cx) / camera.fx, z * (y - camera.cy) / camera.fy, z, 1);
            const glm::dvec3 normal = reference::normal_at(corner, glm::dvec3(world_from_model * local));
            model.at(x, y) = {z, glm::transpose(glm::dmat3(world_from_model)) * normal, glm::dvec2(0), -1};
        }
    }
    reference::TrackPose pose;
    for (int i = 0; i < 12; ++i) {
        const auto equations = reference::track_equations(frame, camera, model, camera, pose, {.gate_m = 0.1});
        pose.model_from_frame = reference::track_step(equations, pose, 1e-4).model_from_frame;
    }
    EXPECT_LT(distance(pose.model_from_frame, motion), 5e-4);
}

}  // namespace
}  // namespace patina::tracking_test
