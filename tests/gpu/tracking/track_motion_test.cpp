#include <algorithm>
#include <cmath>
#include <cstring>

#include <glm/gtc/matrix_transform.hpp>

#include "passes/tracking/judge_motion.h"
#include "tests/gpu/input/input_pictures.h"
#include "tests/gpu/tracking/track_rig.h"

namespace patina::track_motion_test {
namespace {

using reference::DistanceField;

/// The inside of a room's corner: three planes, each of which stops one direction and two rotations.
DistanceField corner() {
    const DistanceField floor = reference::half_space({0, -1, 0}, -0.9), left = reference::half_space({1, 0, 0}, -0.8),
                        back = reference::half_space({0.3, 0, -0.954}, -2.2);
    const DistanceField ball = reference::sphere({0.3, 0.5, 1.7}, 0.35);
    return [=](glm::dvec3 p) { return std::min({floor(p), left(p), back(p), ball(p)}); };
}

DistanceField wall() { return reference::half_space({0.1, -0.05, -0.99}, -1.9); }

glm::vec3 grey(glm::dvec3) { return glm::vec3(0.3f); }
/// Smooth waves of 30 cm.
glm::vec3 waves(glm::dvec3 p) {
    return glm::vec3(0.3 + 0.12 * std::sin(20 * p.x + 8 * p.z) + 0.1 * std::sin(17 * p.y + 1));
}

/// A turn and a shift as from one frame to the next.
RigidTransform small_motion() {
    RigidTransform motion = glm::rotate(RigidTransform(1.0), 0.012, glm::normalize(glm::dvec3(0.4, 1, -0.3)));
    motion[3] = glm::dvec4(0.011, -0.007, 0.014, 1);
    return motion;
}

double angle_between(const RigidTransform& a, const RigidTransform& b) {
    const RigidTransform apart = rigid_inverse(a) * b;
    return std::asin(std::min(
        0.5 * glm::length(glm::dvec3(apart[1][2] - apart[2][1], apart[2][0] - apart[0][2], apart[0][1] - apart[1][0])),
        1.0));
}

class TrackMotionTest : public TrackTest {
  protected:
    struct Search {
        DistanceField scene;
        Paint paint = grey;
        Intrinsics camera = pinhole_camera({128, 106});
        RigidTransform world_from_model = reference::look_at({0.05, -0.1, -0.3}, {0, 0.1, 2});
        RigidTransform model_from_frame = small_motion();
        RigidTransform start{1.0};
        double dimmed = 1;  ///< factor of the frame's colours
        bool colored = false;
        int iterations = 10;
        TrackErrors errors{};
        float held_share = 0.002f;
    };

    gpu::TrackState run_search(const Search& search) {
        const SeenScene model = see(search.scene, search.paint, search.camera, search.world_from_model);
        const SeenScene seen =
            see(search.scene, search.paint, search.camera, search.world_from_model * search.model_from_frame);
        reference::TrackPicture picture{seen.color, search.camera, RigidTransform(1.0)};
        for (glm::vec4& pixel : picture.linear.pixels()) pixel *= glm::vec4(glm::vec3(search.dimmed), 1);
        graph::FrameGraph frame = runner().begin();
        const TrackLevel own =
            pack_frame(frame, seen, search.camera, search.colored ? std::optional(picture) : std::nullopt);
        const TrackLevel packed = pack_model(frame, model, search.camera, search.world_from_model, search.colored);
        const gpu::TrackState start = state_at(search.start, 1.8, 0.7);
        graph::BufferId state = frame.upload<gpu::TrackState>("state", std::span(&start, 1));
        for (int i = 0; i < search.iterations; ++i) {
            const bool first = i < search.iterations / 2;
            const NormalEquations equations =
                add_normal_equations(frame, own, packed, state, search.errors, first ? 2 : 0);
            state = add_solve_motion(frame, equations, state, search.held_share, 50);
        }
        const graph::Readback read = frame.read_back(state);
        run(std::move(frame));
        return read.as<gpu::TrackState>().front();
    }
};

TEST_F(TrackMotionTest, ACornerShowsTheWholeMotion) {
    const gpu::TrackState found = run_search({.scene = corner()});
    const RigidTransform pose = reference_from_frame(found);
    EXPECT_LT(glm::length(glm::dvec3(pose[3] - small_motion()[3])), 3e-4);
    EXPECT_LT(angle_between(pose, small_motion()), 2e-4);
    EXPECT_EQ(found.held, 0);
    EXPECT_EQ(found.solutions, 10);
    EXPECT_GT(found.pairs / found.readings, 0.9f);
    EXPECT_LT(found.sigmas, 0.3f);
    EXPECT_LT(found.step_m, 1e-4f);
}

TEST_F(TrackMotionTest, AlongAWallThePoseStaysAsPredicted) {
    const gpu::TrackState found = run_search({.scene = wall()});
    EXPECT_EQ(found.held, 3);
    EXPECT_LT(found.eigenvalues_low.z, 0.002f);
    EXPECT_GT(found.eigenvalues_low.w, 0.002f);
    // Towards the wall the motion is found, along it there was none.
    const RigidTransform pose = reference_from_frame(found), apart = rigid_inverse(small_motion()) * pose;
    const Search search{.scene = wall()};
    const glm::dvec3 normal = glm::dvec3(rigid_inverse(search.world_from_model * small_motion()) *
                                         glm::dvec4(reference::normal_at(wall(), {0, 0, 1.9}), 0));
    const glm::dvec3 off(apart[3]);
    // The wall as the frame's camera sees it is where it is from the pose found, up to what the turn adds.
    EXPECT_LT(std::abs(glm::dot(off, normal)), 2e-3);
    EXPECT_GT(glm::length(off - glm::dot(off, normal) * normal), 5e-3);
}

TEST_F(TrackMotionTest, ShadesShowTheMotionAlongAPaintedWall) {
    Search search{.scene = wall(), .paint = waves, .colored = true, .iterations = 20};
    const gpu::TrackState found = run_search(search);
    EXPECT_EQ(found.held, 0);
    const RigidTransform pose = reference_from_frame(found);
    EXPECT_LT(glm::length(glm::dvec3(pose[3] - small_motion()[3])), 1e-3);
    EXPECT_LT(angle_between(pose, small_motion()), 5e-4);
    EXPECT_LT(found.shade_error, 0.01f);
    EXPECT_NEAR(found.gain, 1, 0.002);
}

TEST_F(TrackMotionTest, ADarkerPictureIsBroughtToTheModelsExposure) {
    Search search{.scene = wall(), .paint = waves, .dimmed = 0.7, .colored = true, .iterations = 20};
    const gpu::TrackState found = run_search(search);
    // Shades are square roots.
    EXPECT_NEAR(found.gain, 1 / std::sqrt(0.7), 0.003);
    EXPECT_LT(glm::length(glm::dvec3(reference_from_frame(found)[3] - small_motion()[3])), 1e-3);
}

TEST_F(TrackMotionTest, WithoutPairsThePoseStays) {
    RigidTransform away(1.0);
    away[3] = glm::dvec4(0, 0, -6, 1);  // everything lies behind the camera
    const gpu::TrackState found = run_search({.scene = corner(), .start = away});
    EXPECT_EQ(found.solutions, 0);
    EXPECT_EQ(reference_from_frame(found)[3], away[3]);
}

TEST_F(TrackMotionTest, TheSameSearchGivesTheSameBytes) {
    const Search search{.scene = corner(), .paint = waves, .colored = true};
    const gpu::TrackState a = run_search(search), b = run_search(search);
    EXPECT_EQ(std::memcmp(&a, &b, sizeof a), 0);
}

/// What the shader summed up, as the reference tells it.
reference::TrackEquations gathered(const std::vector<float>& sums) {
    std::array<double, gpu::kTrackSums> total{};
    for (size_t i = 0; i < sums.size(); ++i) total[i % gpu::kTrackSums] += sums[i];
    reference::TrackEquations equations;
    size_t entry = gpu::kTrackMatrix;
    for (size_t i = 0; i < 6; ++i) {
        for (size_t j = i; j < 6; ++j) equations.matrix[i][j] = equations.matrix[j][i] = total[entry++];
        equations.right[i] = total[gpu::kTrackRight + i];
    }
    equations.readings = total[gpu::kTrackReadings];
    equations.pairs = total[gpu::kTrackPairs];
    equations.squares = total[gpu::kTrackSquares];
    equations.weight = total[gpu::kTrackWeight];
    equations.depth = total[gpu::kTrackDepth];
    equations.shades = total[gpu::kTrackShades];
    equations.shade_squares = total[gpu::kTrackShadeSquares];
    equations.shade_product = total[gpu::kTrackShadeProduct];
    equations.shade_own = total[gpu::kTrackShadeOwn];
    return equations;
}

void expect_equal(const reference::TrackEquations& got, const reference::TrackEquations& want, double tolerance) {
    double largest = 1e-9, right = 1e-9;
    for (size_t i = 0; i < 6; ++i) {
        largest = std::max(largest, std::abs(want.matrix[i][i]));
        right = std::max(right, std::abs(want.right[i]));
    }
    for (size_t i = 0; i < 6; ++i) {
        for (size_t j = 0; j < 6; ++j) EXPECT_NEAR(got.matrix[i][j], want.matrix[i][j], tolerance * largest) << i << j;
        EXPECT_NEAR(got.right[i], want.right[i], tolerance * right + 1e-6 * largest) << i;
    }
    EXPECT_EQ(got.readings, want.readings);
    EXPECT_NEAR(got.pairs, want.pairs, tolerance * want.pairs + 1e-6);
    EXPECT_NEAR(got.squares, want.squares, tolerance * want.squares + 1e-6 * want.pairs);
    EXPECT_NEAR(got.weight, want.weight, tolerance * want.weight);
    EXPECT_NEAR(got.depth, want.depth, 1e-5 * want.depth);
    EXPECT_NEAR(got.shades, want.shades, tolerance * want.shades + 1e-6);
    EXPECT_NEAR(got.shade_squares, want.shade_squares, tolerance * want.shade_squares + 1e-6 * want.shades);
    EXPECT_NEAR(got.shade_product, want.shade_product, tolerance * want.shade_product);
    EXPECT_NEAR(got.shade_own, want.shade_own, tolerance * want.shade_own);
}

TEST_F(TrackMotionTest, EquationsAndSolutionAgreeWithTheReference) {
    for (const Extent2D extent : kPictureExtents) {
        const Intrinsics camera = pinhole_camera(extent);
        const Search search{.scene = corner(), .paint = waves};
        const SeenScene model = see(search.scene, search.paint, camera, search.world_from_model);
        const SeenScene seen = see(search.scene, search.paint, camera, search.world_from_model * small_motion());
        const reference::TrackPicture picture{rounded_to_halves(seen.color), camera, RigidTransform(1.0)};
        graph::FrameGraph frame = runner().begin();
        const TrackLevel own = pack_frame(frame, seen, camera, picture);
        const TrackLevel packed = pack_model(frame, model, camera, search.world_from_model, true);
        const gpu::TrackState start = state_at(RigidTransform(1.0), 1.8, 0.7, 0.97);
        const auto state = frame.upload<gpu::TrackState>("state", std::span(&start, 1));
        TrackErrors errors{};
        const NormalEquations equations = add_normal_equations(frame, own, packed, state, errors, 0);
        const graph::Readback read_own = frame.read_back(own.pixels), read_model = frame.read_back(packed.pixels),
                              read_sums = frame.read_back(equations.sums);
        const graph::Readback read_state = frame.read_back(add_solve_motion(frame, equations, state, 0.002f, 50));
        run(std::move(frame));

        const reference::TrackPose pose{RigidTransform(1.0), 0.97f, 1.8f, 0.7f};
        const reference::TrackComparison comparison{errors.noise_floor_m, errors.noise_per_m, errors.robust_sigmas,
                                                    errors.gate_m,        errors.gate_slope,  errors.shade_sigma,
                                                    errors.robust_shade};
        const reference::TrackEquations expected =
            reference::track_equations(readings(read_own.as<uint32_t>(), extent), camera,
                                       surfaces(read_model.as<uint32_t>(), extent), camera, pose, comparison);
        // Single precision; a point between two pixels may be paired with either.
        expect_equal(gathered(read_sums.as<float>()), expected, 2e-3);
        const auto moved = read_state.as<gpu::TrackState>().front();
        if (expected.pairs < 50) {
            EXPECT_EQ(moved.solutions, 0);
            continue;
        }
        const reference::TrackStep step = reference::track_step(expected, pose, 0.002f);
        const RigidTransform got = reference_from_frame(moved);
        EXPECT_LT(glm::length(glm::dvec3(got[3] - step.model_from_frame[3])), 1e-4);
        EXPECT_LT(angle_between(got, step.model_from_frame), 1e-4);
        EXPECT_EQ(moved.held, step.held);
        EXPECT_NEAR(moved.eigenvalues_low.x, step.eigenvalues[0], 2e-3 * step.eigenvalues[5]);
        EXPECT_NEAR(moved.eigenvalues_low.w, step.eigenvalues[3], 2e-3 * step.eigenvalues[5]);
        EXPECT_NEAR(moved.eigenvalues_high.y, step.eigenvalues[5], 2e-3 * step.eigenvalues[5]);
    }
}

TEST_F(TrackMotionTest, ANoiseOfNothingIsAnError) {
    TrackErrors errors;
    errors.noise_floor_m = 0;
    graph::FrameGraph frame = runner().begin();
    EXPECT_THAT([&] { add_normal_equations(frame, {}, {}, {}, errors, 0); },
                ::testing::ThrowsMessage<Error>(::testing::HasSubstr("tracking.noise_floor_m is 0")));
}

}  // namespace
}  // namespace patina::track_motion_test
