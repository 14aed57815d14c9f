#include "reconstruction/pipeline.h"
#include "reconstruction/session/rgbd_frame.h"
#include "tests/gpu/gpu_test.h"
#include "tests/gpu/scenes/small_office.h"

namespace patina::relocalisation_test {
namespace {

constexpr uint32_t kFrames = 40;

ReconstructionSettings tracked_settings() {
    ReconstructionSettings settings;
    settings.map.voxel_m = 0.02f;
    settings.map.capacity_blocks = 16384;
    settings.fusion.truncation_m = 0.06f;
    settings.tracking.emplace();
    settings.tracking->finest = 0;  // the pictures are small
    settings.keyframes.emplace();
    return settings;
}

/// A camera that is tracked from its first true pose on.
class Relocalisation : public GpuTest {
  protected:
    static const SmallOffice& office() {
        static const SmallOffice frames(device(), kFrames);
        return frames;
    }

    /// Gives the frame to the reconstruction at the time of step `step`; returns its state.
    static TrackingState add(Pipeline& pipeline, uint32_t index, uint32_t step) {
        RgbdFrame rgbd = patina::to_rgbd(office().info, office().frames[index]);
        rgbd.time.timestamp_s = step / office().info.fps;
        pipeline.add(rgbd);
        return pipeline.tracking_report()->state;
    }

    /// What of the first frames tracks is the map of the tests.
    static void track_first(Pipeline& pipeline, uint32_t frames) {
        for (uint32_t i = 0; i < frames; ++i) {
            ASSERT_EQ(add(pipeline, i, i), TrackingState::kTracking)
                << "frame " << i << ": " << pipeline.tracking_report()->reason;
        }
    }

    static void expect_pose_of(const Pipeline& pipeline, uint32_t index) {
        const PoseError error = pose_error(pipeline.tracking_report()->world_from_depth, office().frames[index]);
        EXPECT_LT(error.translation_m, 0.02) << "frame " << index;
        EXPECT_LT(error.rotation_degrees, 0.7) << "frame " << index;
    }

    static RgbdFrame dark_frame(uint32_t step) {
        static const Image<uint16_t> depth(office().info.depth.extent);
        static const Image<glm::u8vec3> color(office().info.color.extent);
        RgbdFrame rgbd = patina::to_rgbd(office().info, office().frames[0]);
        rgbd.depth.pixels = std::span(depth.pixels());
        rgbd.color.pixels = std::span(color.pixels());
        rgbd.time.timestamp_s = step / office().info.fps;
        return rgbd;
    }
};

TEST_F(Relocalisation, ATeleportedCameraIsFoundAndTracksOn) {
    Pipeline pipeline(device(), tracked_settings());
    track_first(pipeline, kFrames);
    for (uint32_t i = 5; i < 9; ++i) {
        ASSERT_EQ(add(pipeline, i, kFrames + i), TrackingState::kTracking)
            << "frame " << i << ": " << pipeline.tracking_report()->reason;
        expect_pose_of(pipeline, i);
    }
    EXPECT_EQ(pipeline.frames(), kFrames + 4);
}

TEST_F(Relocalisation, WithoutKeyframesItStaysLost) {
    ReconstructionSettings settings = tracked_settings();
    settings.keyframes.reset();
    Pipeline pipeline(device(), settings);
    track_first(pipeline, kFrames);
    EXPECT_NE(add(pipeline, 5, kFrames + 5), TrackingState::kTracking);
    EXPECT_EQ(pipeline.frames(), kFrames);
}

TEST_F(Relocalisation, WhatTheMapDoesNotShowIsLostAndNotFused) {
    Pipeline pipeline(device(), tracked_settings());
    track_first(pipeline, 8);
    const uint32_t free_before = (pipeline.wait(), pipeline.counters().map.free_blocks);
    EXPECT_EQ(add(pipeline, kFrames - 1, 8), TrackingState::kLost);
    EXPECT_EQ(add(pipeline, kFrames - 2, 9), TrackingState::kLost);
    pipeline.wait();
    EXPECT_EQ(pipeline.frames(), 8u);
    EXPECT_EQ(pipeline.counters().map.free_blocks, free_before);
    EXPECT_EQ(add(pipeline, 8, 10), TrackingState::kTracking);  // the view is back
    expect_pose_of(pipeline, 8);
}

TEST_F(Relocalisation, InTheDarkNothingIsFusedAndTrackingReturnsWithTheView) {
    Pipeline pipeline(device(), tracked_settings());
    track_first(pipeline, 10);
    for (uint32_t step = 10; step < 14; ++step) {
        pipeline.add(dark_frame(step));
        EXPECT_EQ(pipeline.tracking_report()->state, TrackingState::kLost) << step;
    }
    EXPECT_EQ(pipeline.frames(), 10u);
    EXPECT_EQ(add(pipeline, 3, 14), TrackingState::kTracking);  // elsewhere than it was lost
    expect_pose_of(pipeline, 3);
}

TEST_F(Relocalisation, TheSameFramesGiveTheSamePoses) {
    std::vector<RigidTransform> poses[2];
    for (auto& run : poses) {
        Pipeline pipeline(device(), tracked_settings());
        for (const uint32_t index : {0, 1, 2, 3, 4, 5, 6, 7, 30, 2, 3}) {
            add(pipeline, index, static_cast<uint32_t>(run.size()));
            run.push_back(pipeline.tracking_report()->world_from_depth);
        }
    }
    EXPECT_EQ(poses[0], poses[1]);
}

}  // namespace
}  // namespace patina::relocalisation_test
