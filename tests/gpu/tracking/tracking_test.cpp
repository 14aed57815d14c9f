#include <algorithm>
#include <cmath>

#include "reconstruction/pipeline.h"
#include "tests/gpu/input/input_pictures.h"
#include "tests/gpu/tracking/track_rig.h"

namespace patina::tracking_test {
namespace {

using reference::DistanceField;
using ::testing::HasSubstr;

/// A corner of a room with a ball and a box in it.
DistanceField room() {
    const DistanceField floor = reference::half_space({0, -1, 0}, -0.9), left = reference::half_space({1, 0, 0}, -1.2),
                        back = reference::half_space({0, 0, -1}, -2.4), ball = reference::sphere({0.5, 0.45, 1.7}, 0.4),
                        box = reference::box({-0.6, 0.6, 1.5}, {0.25, 0.3, 0.2});
    return [=](glm::dvec3 p) { return std::min({floor(p), left(p), back(p), ball(p), box(p)}); };
}

glm::vec3 waves(glm::dvec3 p) {
    return glm::vec3(0.3 + 0.12 * std::sin(14 * p.x + 5 * p.z) + 0.1 * std::sin(12 * p.y + 1));
}

/// As a hand moves a camera at 30 Hz: 0.3 m/s, 15 degrees a second.
RigidTransform pose_at(double frame) {
    const double t = frame / 30;
    return reference::look_at({0.3 * std::sin(t), -0.1 + 0.1 * std::sin(1.7 * t), -0.3 + 0.2 * std::sin(t)},
                              {-0.1 + 0.4 * std::sin(0.9 * t + 0.5), 0.3, 2});
}

struct Shot {
    Image<float> depth_m;
    Image<glm::vec3> color;
};

class TrackingTest : public GpuTest {
  protected:
    static constexpr double kMost_m = 0.01;

    static ReconstructionSettings settings() {
        ReconstructionSettings settings;
        settings.map.voxel_m = 0.02f;
        settings.map.capacity_blocks = 8192;
        settings.fusion.truncation_m = 0.06f;
        settings.tracking.emplace();
        settings.tracking->finest = 0;
        settings.tracking->bounds.least_pairs = 300;
        return settings;
    }

    Shot shoot(const DistanceField& scene, const RigidTransform& pose) const {
        const SeenScene seen = see(scene, waves, camera_, pose);
        Shot shot{seen.depth_m, Image<glm::vec3>(camera_.extent)};
        std::transform(seen.color.pixels().begin(), seen.color.pixels().end(), shot.color.pixels().begin(),
                       [](glm::vec4 pixel) { return glm::vec3(pixel); });
        return shot;
    }

    RgbdFrame frame_of(const Shot& shot, const RigidTransform& world_from_depth) const {
        RgbdFrame rgbd;
        rgbd.depth.pixels = std::span(shot.depth_m.pixels());
        rgbd.color.pixels = std::span(shot.color.pixels());
        rgbd.depth.camera = rgbd.color.camera = camera_;
        rgbd.world_from_depth = world_from_depth;
        return rgbd;
    }

    bool add(Pipeline& pipeline, const Shot& shot, double frame, const RigidTransform& start) const {
        RgbdFrame rgbd = frame_of(shot, start);
        rgbd.time.timestamp_s = frame / 30;
        return pipeline.add(rgbd);
    }

    bool add(Pipeline& pipeline, double frame) const {
        return add(pipeline, shoot(room(), pose_at(frame)), frame, pose_at(0));
    }

    static double error_m(Pipeline& pipeline, double frame) {
        return glm::length(glm::dvec3(pipeline.tracking_report()->world_from_depth[3] - pose_at(frame)[3]));
    }

    static TrackingState state(Pipeline& pipeline) { return pipeline.tracking_report()->state; }

    const Intrinsics camera_ = pinhole_camera({128, 106});
};

TEST_F(TrackingTest, FollowsACameraAroundARoom) {
    Pipeline pipeline(device(), settings());
    for (int frame = 0; frame < 20; ++frame) {
        ASSERT_TRUE(add(pipeline, frame)) << frame << ": " << pipeline.tracking_report()->reason;
        EXPECT_LT(error_m(pipeline, frame), kMost_m) << frame;
    }
    EXPECT_EQ(pipeline.frames(), 20u);
}

TEST_F(TrackingTest, EveryGraphIsSound) {
    Pipeline pipeline(device(), settings());
    for (int frame = 0; frame < 3; ++frame) {
        add(pipeline, frame);
        const graph::CompiledFrame& compiled = pipeline.runner().last_frame();
        EXPECT_THAT(graph::check(compiled.description, compiled.plan), ::testing::IsEmpty());
        EXPECT_THAT(graph::find_unneeded_barriers(compiled.description, compiled.plan), ::testing::IsEmpty());
    }
    pipeline.wait();  // fuses kept pictures alone
    const graph::CompiledFrame& last = pipeline.runner().last_frame();
    EXPECT_THAT(graph::check(last.description, last.plan), ::testing::IsEmpty());
    EXPECT_THAT(graph::find_unneeded_barriers(last.description, last.plan), ::testing::IsEmpty());
}

TEST_F(TrackingTest, DroppedFramesAreCaughtUpWith) {
    Pipeline pipeline(device(), settings());
    for (int frame = 0; frame < 24; frame += 2) {
        ASSERT_TRUE(add(pipeline, frame)) << frame << ": " << pipeline.tracking_report()->reason;
        EXPECT_LT(error_m(pipeline, frame), kMost_m) << frame;
    }
}

TEST_F(TrackingTest, ABlackoutIsALossAndEndsWithIt) {
    Pipeline pipeline(device(), settings());
    for (int frame = 0; frame < 6; ++frame) ASSERT_TRUE(add(pipeline, frame));
    const Shot black{Image<float>(camera_.extent, 0.0f), Image<glm::vec3>(camera_.extent)};
    for (int frame = 6; frame < 26; ++frame) {
        EXPECT_FALSE(add(pipeline, black, frame, pose_at(0)));
        EXPECT_EQ(state(pipeline), TrackingState::kLost);
        EXPECT_THAT(pipeline.tracking_report()->reason, HasSubstr("only 0 of 0 readings"));
    }
    EXPECT_EQ(pipeline.frames(), 6u);
    for (int frame = 26; frame < 29; ++frame) {
        ASSERT_TRUE(add(pipeline, frame)) << pipeline.tracking_report()->reason;
        EXPECT_LT(error_m(pipeline, frame), kMost_m) << frame;
    }
}

TEST_F(TrackingTest, BeforeAWallAloneItIsWeakAndFusesNothing) {
    const DistanceField wall = reference::half_space({0, 0, -1}, -1.5);
    ReconstructionSettings depth_only = settings();
    depth_only.tracking->photometric = false;
    Pipeline pipeline(device(), depth_only);
    ASSERT_TRUE(add(pipeline, shoot(wall, pose_at(0)), 0, pose_at(0)));
    for (int frame = 1; frame < 6; ++frame) {
        EXPECT_FALSE(add(pipeline, shoot(wall, pose_at(frame)), frame, pose_at(0)));
        EXPECT_EQ(state(pipeline), TrackingState::kWeak);
        EXPECT_THAT(pipeline.tracking_report()->reason, HasSubstr("leaves 3 directions of motion open"));
        // What the wall shows is found: how far it is.
        EXPECT_NEAR(pipeline.tracking_report()->world_from_depth[3].z, pose_at(frame)[3].z, 0.005);
    }
    EXPECT_EQ(pipeline.frames(), 1u);
}

TEST_F(TrackingTest, WithTheLightOffDepthLeads) {
    Pipeline pipeline(device(), settings());
    for (int frame = 0; frame < 16; ++frame) {
        Shot shot = shoot(room(), pose_at(frame));
        if (frame >= 5 && frame < 11) shot.color = Image<glm::vec3>(camera_.extent, glm::vec3(0.001f));
        ASSERT_TRUE(add(pipeline, shot, frame, pose_at(0))) << frame << ": " << pipeline.tracking_report()->reason;
        EXPECT_LT(error_m(pipeline, frame), kMost_m) << frame;
    }
}

TEST_F(TrackingTest, ARelocaliserEndsALoss) {
    Pipeline pipeline(device(), settings());
    for (int frame = 0; frame < 5; ++frame) ASSERT_TRUE(add(pipeline, frame));
    // Half a metre aside: farther than a camera moves from frame to frame.
    const auto far_pose = [](int i) { return reference::look_at({0.5 + 0.01 * i, -0.2, -0.2}, {0.1, 0.3, 2}); };
    const auto add_far = [&](int i) { return add(pipeline, shoot(room(), far_pose(i)), 5 + i, pose_at(0)); };
    const auto far_error_m = [&](int i) {
        return glm::length(glm::dvec3(pipeline.tracking_report()->world_from_depth[3] - far_pose(i)[3]));
    };
    EXPECT_FALSE(add_far(0));
    EXPECT_EQ(state(pipeline), TrackingState::kLost);
    int asked = 0;
    pipeline.set_relocaliser([&](const RgbdFrame&) {
        ++asked;
        RigidTransform near_by = far_pose(1), wrong = pose_at(0);
        near_by[3] += glm::dvec4(0.01, -0.01, 0.01, 0);
        wrong[3] += glm::dvec4(0, 0, -2, 0);
        return std::vector{wrong, near_by};
    });
    ASSERT_TRUE(add_far(1)) << pipeline.tracking_report()->reason;
    EXPECT_LT(far_error_m(1), kMost_m);
    ASSERT_TRUE(add_far(2)) << pipeline.tracking_report()->reason;
    EXPECT_LT(far_error_m(2), kMost_m);
    EXPECT_EQ(asked, 1);
}

TEST_F(TrackingTest, TheFirstFrameNeedsReadings) {
    Pipeline pipeline(device(), settings());
    const Shot black{Image<float>(camera_.extent, 0.0f), Image<glm::vec3>(camera_.extent)};
    EXPECT_FALSE(add(pipeline, black, 0, pose_at(0)));
    EXPECT_THAT(pipeline.tracking_report()->reason, HasSubstr("the first frame has 0 readings"));
    EXPECT_TRUE(add(pipeline, 1));
    EXPECT_EQ(pipeline.tracking_report()->world_from_depth, pose_at(0));
}

TEST_F(TrackingTest, TheSameFramesGiveTheSameBytes) {
    const auto run = [&] {
        Pipeline pipeline(device(), settings());
        for (int frame = 0; frame < 8; ++frame) add(pipeline, frame);
        return std::pair(pipeline.tracking_report()->world_from_depth, pipeline.extract_surface().positions_m);
    };
    EXPECT_EQ(run(), run());
}

TEST_F(TrackingTest, ATrackedFrameIsOneSubmission) {
    Pipeline pipeline(device(), settings());
    const auto submissions = [&] { return pipeline.runner().host_timing().samples_ms.size(); };
    const auto conversions = [&] {
        size_t count = 0;
        for (const graph::Timing& pass : pipeline.runner().pass_timings()) {
            if (pass.name == "input.convert_depth" || pass.name == "input.convert_color")
                count += pass.samples_ms.size();
        }
        return count;
    };
    ASSERT_TRUE(add(pipeline, 0));
    const size_t before = submissions();
    for (int frame = 1; frame < 6; ++frame) ASSERT_TRUE(add(pipeline, frame));
    EXPECT_EQ(submissions() - before, 5u);
    EXPECT_EQ(pipeline.frames(), 6u) << "the last one waits to be fused, and counts";
    pipeline.wait();
    EXPECT_EQ(submissions() - before, 6u) << "which fuses it";
    EXPECT_EQ(conversions(), 2 * 6u) << "each picture once";
    EXPECT_EQ(pipeline.frames(), 6u);
    pipeline.wait();
    EXPECT_EQ(submissions() - before, 6u) << "nothing waits any more";
}

TEST_F(TrackingTest, WhatWaitsIsFusedBeforeTheModelIsLookedAt) {
    const auto seen_after_three = [&](bool given, bool surface) {
        Pipeline tracked(device(), settings()), posed(device(), settings());
        for (int frame = 0; frame < 3; ++frame) {
            // A caller's pictures are its own again after add().
            Shot shot = shoot(room(), pose_at(frame));
            EXPECT_TRUE(add(tracked, shot, frame, pose_at(0)));
            posed.add_posed(frame_of(shot, tracked.tracking_report()->world_from_depth));
            std::ranges::fill(shot.depth_m.pixels(), 9.0f);
        }
        Pipeline& shown = given ? posed : tracked;
        if (surface) return shown.extract_surface().positions_m;
        const ViewReadback view = shown.view(camera_, pose_at(1));
        shown.wait();
        std::vector<glm::vec3> seen;
        const ModelView pictures = view.get();
        for (const glm::vec4 position : pictures.position_m.pixels()) seen.emplace_back(position);
        return seen;
    };
    for (const bool surface : {false, true}) {
        const std::vector<glm::vec3> tracked = seen_after_three(false, surface);
        EXPECT_GT(std::ranges::count_if(tracked, [](glm::vec3 p) { return p != glm::vec3(0); }), 10000) << surface;
        EXPECT_EQ(tracked, seen_after_three(true, surface)) << surface;
    }
}

TEST_F(TrackingTest, AFrameOfGivenPoseComesAfterTheOneThatWaits) {
    Pipeline pipeline(device(), settings());
    ASSERT_TRUE(add(pipeline, 0));
    ASSERT_TRUE(add(pipeline, 1));
    const Shot shot = shoot(room(), pose_at(2));
    const size_t before = pipeline.runner().host_timing().samples_ms.size();
    pipeline.add_posed(frame_of(shot, pose_at(2)));
    EXPECT_EQ(pipeline.runner().host_timing().samples_ms.size() - before, 2u) << "the one that waited, and this";
    EXPECT_EQ(pipeline.frames(), 3u);
}

TEST_F(TrackingTest, AFrameThatCannotBeReadLosesNothing) {
    const auto surface_after = [&](bool with_wrong_frame) {
        Pipeline pipeline(device(), settings());
        EXPECT_TRUE(add(pipeline, 0));
        EXPECT_TRUE(add(pipeline, 1));
        if (with_wrong_frame) {
            const Shot shot = shoot(room(), pose_at(2));
            RgbdFrame wrong = frame_of(shot, pose_at(0));
            wrong.depth.max_metres = -1;
            EXPECT_THROW(pipeline.add(wrong), Error);
        }
        EXPECT_EQ(pipeline.frames(), 2u);
        EXPECT_TRUE(add(pipeline, 2)) << pipeline.tracking_report()->reason;
        return pipeline.extract_surface().positions_m;
    };
    EXPECT_EQ(surface_after(true), surface_after(false));
}

TEST_F(TrackingTest, SettingsOutOfRangeAreNamed) {
    ReconstructionSettings wrong = settings();
    wrong.tracking->finest = 3;
    EXPECT_THAT([&] { Pipeline(device(), wrong); },
                ::testing::ThrowsMessage<Error>(HasSubstr("tracking.finest is 3, it must be 0 to 2")));
}

}  // namespace
}  // namespace patina::tracking_test
