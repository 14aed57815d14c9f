#include "tools/eval/trajectory.h"

#include <cmath>

#include <glm/gtc/matrix_transform.hpp>
#include <gmock/gmock.h>

#include "tests/export/temporary_folder.h"
#include "tests/export/throws.h"

namespace patina::eval::trajectory_test {
namespace {

using sensor::StampedPose;

RigidTransform turned(double degrees, glm::dvec3 axis) {
    return glm::rotate(RigidTransform(1), glm::radians(degrees), axis);
}

RigidTransform moved(glm::dvec3 offset_m) { return glm::translate(RigidTransform(1), offset_m); }

/// A camera on a winding path at 10 Hz.
std::vector<StampedPose> winding_path(size_t poses = 40) {
    std::vector<StampedPose> path;
    for (size_t i = 0; i < poses; ++i) {
        const double t = 0.1 * static_cast<double>(i);
        const glm::dvec3 position(std::sin(t), 0.3 * std::cos(2 * t), 0.5 * t);
        path.push_back({t, moved(position) * turned(20 * std::sin(t), {0.6, 0.8, 0})});
    }
    return path;
}

/// The path with each pose moved in the world by change(i).
template <class Change>
std::vector<StampedPose> changed(Change change) {
    std::vector<StampedPose> path = winding_path();
    for (size_t i = 0; i < path.size(); ++i) path[i].world_from_camera = change(i) * path[i].world_from_camera;
    return path;
}

TrajectoryErrors errors_of(const std::vector<StampedPose>& run) {
    const std::vector<StampedPose> truth = winding_path();
    return trajectory_errors(pair_poses(truth, run, 0.02), truth.size(), run.size());
}

TEST(Trajectory, TheTruePosesHaveNoError) {
    const TrajectoryErrors errors = errors_of(winding_path());
    EXPECT_EQ(errors.poses, 40u);
    EXPECT_NEAR(errors.ate_rmse_m, 0, 1e-12);
    EXPECT_EQ(errors.unaligned_rmse_m, 0);
    EXPECT_NEAR(errors.per_frame->translation_rmse_m, 0, 1e-12);
    EXPECT_NEAR(errors.per_second->rotation_rmse_deg, 0, 1e-9);
}

TEST(Trajectory, AnotherWorldIsNoErrorAfterAlignment) {
    const TrajectoryErrors errors = errors_of(changed([](size_t) { return moved({0.3, 0, 0.4}); }));
    EXPECT_NEAR(errors.ate_rmse_m, 0, 1e-12);
    EXPECT_NEAR(errors.unaligned_rmse_m, 0.5, 1e-12);
    EXPECT_NEAR(errors.per_frame->translation_rmse_m, 0, 1e-12);
    const auto turned_world = [](size_t) { return moved({1, 2, 3}) * turned(130, {0, 0.6, 0.8}); };
    EXPECT_NEAR(errors_of(changed(turned_world)).ate_rmse_m, 0, 1e-12);
    EXPECT_NEAR(errors_of(changed(turned_world)).per_second->rotation_rmse_deg, 0, 1e-9);
}

TEST(Trajectory, AlignmentDoesNotScaleOrMirror) {
    std::vector<StampedPose> larger = winding_path(), mirrored = winding_path();
    for (StampedPose& pose : larger) pose.world_from_camera[3] *= glm::dvec4(2, 2, 2, 1);
    for (StampedPose& pose : mirrored) pose.world_from_camera[3].x *= -1;
    EXPECT_GT(errors_of(larger).ate_rmse_m, 0.5);
    EXPECT_GT(errors_of(mirrored).ate_rmse_m, 0.1);
}

TEST(Trajectory, AteIsTheRootMeanSquareOfWhatIsLeft) {
    const auto shaken = [](size_t i) { return moved({0, i % 2 == 0 ? 0.01 : -0.01, 0}); };
    const TrajectoryErrors errors = errors_of(changed(shaken));
    EXPECT_NEAR(errors.unaligned_rmse_m, 0.01, 1e-12);
    EXPECT_NEAR(errors.ate_rmse_m, 0.01, 2e-4);  // alternating offsets leave little that a rigid motion could take up
    EXPECT_NEAR(errors.per_frame->translation_rmse_m, 0.02, 1e-12);
    EXPECT_NEAR(errors.per_second->translation_rmse_m, 0, 1e-12);  // ten frames on, the offset is the same
}

TEST(Trajectory, DriftPerFrameIsTheRelativePoseError) {
    // Straight ahead without turning, so that steps add up.
    std::vector<StampedPose> truth, run;
    for (size_t i = 0; i < 40; ++i) {
        const double t = 0.1 * static_cast<double>(i);
        truth.push_back({t, moved({0, 0, t})});
        run.push_back({t, moved({0, 0, 1.02 * t})});
    }
    const TrajectoryErrors errors = trajectory_errors(pair_poses(truth, run, 0.02), truth.size(), run.size());
    EXPECT_EQ(errors.per_frame->pairs, 39u);
    EXPECT_NEAR(errors.per_frame->step_s, 0.1, 1e-12);
    EXPECT_NEAR(errors.per_frame->translation_rmse_m, 0.002, 1e-12);
    EXPECT_NEAR(errors.per_frame->translation_max_m, 0.002, 1e-12);
    EXPECT_EQ(errors.per_second->pairs, 30u);
    EXPECT_NEAR(errors.per_second->step_s, 1, 1e-12);
    EXPECT_NEAR(errors.per_second->translation_rmse_m, 0.02, 1e-12);
}

TEST(Trajectory, TurningSlowlyIsRotationError) {
    const auto turning = [](size_t i) { return turned(0.05 * static_cast<double>(i), {0, 1, 0}); };
    std::vector<StampedPose> truth(40), run(40);
    for (size_t i = 0; i < truth.size(); ++i) {
        truth[i].timestamp_s = run[i].timestamp_s = 0.1 * static_cast<double>(i);
        run[i].world_from_camera = turning(i);
    }
    const TrajectoryErrors errors = trajectory_errors(pair_poses(truth, run, 0.02), truth.size(), run.size());
    EXPECT_NEAR(errors.per_frame->rotation_rmse_deg, 0.05, 1e-9);
    EXPECT_NEAR(errors.per_second->rotation_rmse_deg, 0.5, 1e-9);
    EXPECT_NEAR(errors.per_second->rotation_max_deg, 0.5, 1e-9);
    EXPECT_EQ(errors.ate_rmse_m, 0);
}

TEST(Trajectory, OneWrongPoseLeavesTheMedianAlone) {
    const TrajectoryErrors errors = errors_of(changed([](size_t i) { return moved({0, i == 20 ? 0.5 : 0, 0}); }));
    EXPECT_NEAR(errors.per_frame->translation_median_m, 0, 1e-12);
    EXPECT_NEAR(errors.per_frame->translation_max_m, 0.5, 1e-12);
    EXPECT_NEAR(errors.per_frame->translation_rmse_m, 0.5 * std::sqrt(2.0 / 39), 1e-12);
    const auto drifting = [](size_t i) { return moved({0, 0.01 * static_cast<double>(i * i), 0}); };
    // Steps of 0.01 (2 i + 1), i from 0 to 38, as the path's rotations leave lengths alone.
    EXPECT_NEAR(errors_of(changed(drifting)).per_frame->translation_median_m, 0.01 * 39, 1e-12);
}

TEST(Trajectory, ALostFrameMakesALongerStep) {
    std::vector<StampedPose> run = winding_path();
    run.erase(run.begin() + 17);
    const TrajectoryErrors errors = errors_of(run);
    EXPECT_EQ(errors.poses, 39u);
    EXPECT_EQ(errors.truth_poses, 40u);
    EXPECT_EQ(errors.per_frame->pairs, 38u);
    EXPECT_EQ(errors.per_second->pairs, 28u);  // it was a start and an end
}

TEST(Trajectory, ShortOnesHaveNoRelativeError) {
    const std::vector<StampedPose> one = winding_path(1), five = winding_path(5);
    EXPECT_FALSE(trajectory_errors(pair_poses(one, one, 0.02), 1, 1).per_frame);
    const TrajectoryErrors errors = trajectory_errors(pair_poses(five, five, 0.02), 5, 5);
    EXPECT_TRUE(errors.per_frame);
    EXPECT_FALSE(errors.per_second);
}

TEST(Trajectory, AlignsTheWorldsOfARestingCamera) {
    const RigidTransform truth_from_run = moved({1, -2, 3}) * turned(75, {0.8, 0, 0.6});
    std::vector<StampedPose> truth, run;
    for (int i = 0; i < 5; ++i) {
        const RigidTransform pose = moved({0.5, 0.5, 0.5}) * turned(10.0 * i, {0, 1, 0});
        truth.push_back({0.1 * i, truth_from_run * pose});
        run.push_back({0.1 * i, pose});
    }
    const RigidTransform found = align_worlds(pair_poses(truth, run, 0.02));
    for (int column = 0; column < 4; ++column) {
        for (int row = 0; row < 4; ++row) EXPECT_NEAR(found[column][row], truth_from_run[column][row], 1e-12);
    }
}

TEST(Trajectory, ReadsBackWhatWasWritten) {
    const test::TemporaryFolder folder;
    const std::vector<StampedPose> path = winding_path();
    sensor::write_trajectory(folder / "trajectory.txt", path);
    const std::vector<StampedPose> read = sensor::read_trajectory(folder / "trajectory.txt");
    ASSERT_EQ(read.size(), path.size());
    for (size_t i = 0; i < path.size(); ++i) {
        EXPECT_EQ(read[i].timestamp_s, path[i].timestamp_s);
        EXPECT_NEAR(read[i].world_from_camera[1][2], path[i].world_from_camera[1][2], 1e-12);
        EXPECT_EQ(read[i].world_from_camera[3], path[i].world_from_camera[3]);
    }
    sensor::write_trajectory(folder / "empty.txt", {});
    EXPECT_THAT([&] { sensor::read_trajectory(folder / "empty.txt"); },
                test::throws_error_with("empty.txt has no poses"));
    EXPECT_THAT([&] { sensor::read_trajectory(folder / "none.txt"); },
                test::throws_error_with("none.txt does not exist"));
}

}  // namespace
}  // namespace patina::eval::trajectory_test
