#include "reconstruction/frame_context.h"

#include <vector>

#include <glm/gtc/matrix_transform.hpp>
#include <gmock/gmock.h>

#include "patina/error.h"

namespace patina::frame_context_test {
namespace {

const Intrinsics kDepthCamera{{8, 6}, 9, 9, 3.5, 2.5, {}}, kColorCamera{{16, 12}, 18, 17, 7.5, 5.5, {}};

RigidTransform at(glm::dvec3 place_m, double angle = 0) {
    return glm::rotate(glm::translate(RigidTransform(1.0), place_m), angle, glm::dvec3(0, 1, 0));
}

/// A frame with pictures of its own; the colour camera is 5 cm to the right of the depth camera.
struct Shot {
    explicit Shot(const RigidTransform& world_from_depth = RigidTransform(1.0)) {
        frame.depth = {std::span<const float>(depth), kDepthCamera};
        frame.color = {std::span<const glm::vec3>(color), kColorCamera};
        frame.color_from_depth = at({-0.05, 0, 0});
        frame.world_from_depth = world_from_depth;
    }

    std::vector<float> depth = std::vector<float>(kDepthCamera.extent.area(), 1.0f);
    std::vector<glm::vec3> color = std::vector<glm::vec3>(kColorCamera.extent.area(), glm::vec3(0.5f));
    RgbdFrame frame;
};

/// Where a shader's camera has a point of the world, in camera coordinates.
glm::vec3 seen_from(const gpu::Camera& camera, glm::vec3 point_m) {
    return glm::vec3(camera.camera_from_world * glm::vec4(point_m, 1));
}

TEST(FrameContext, BothCamerasStandWhereTheFrameWasTaken) {
    const Shot shot(at({1, 2, 3}));
    const FrameContext context = make_frame_context(shot.frame, {}, {}, true);
    EXPECT_LT(glm::length(seen_from(context.depth.gpu, {1, 2, 4}) - glm::vec3(0, 0, 1)), 1e-6f);
    EXPECT_LT(glm::length(seen_from(context.color.gpu, {1, 2, 4}) - glm::vec3(-0.05f, 0, 1)), 1e-6f);
    EXPECT_LT(glm::length(glm::dvec3(context.color.world_from_camera[3]) - glm::dvec3(1.05, 2, 3)), 1e-12);
    EXPECT_EQ(context.depth.gpu.focal_center_px, glm::vec4(9, 9, 3.5, 2.5));
    EXPECT_EQ(context.color.gpu.focal_center_px, glm::vec4(18, 17, 7.5, 5.5));
    EXPECT_EQ(context.color.gpu.extent, glm::uvec2(16, 12));
}

TEST(FrameContext, TheColourCameraTurnsWithTheDepthCamera) {
    const RigidTransform pose = at({0, 0, 0}, glm::radians(90.0));  // looks along the world's x
    const FrameCameras cameras = make_frame_cameras(Shot(pose).frame);
    EXPECT_LT(glm::length(seen_from(cameras.depth.gpu, {2, 0, 0}) - glm::vec3(0, 0, 2)), 1e-6f);
    EXPECT_LT(glm::length(glm::dvec3(cameras.color.world_from_camera[3]) - glm::dvec3(0, 0, -0.05)), 1e-12);
}

TEST(FrameContext, AResizedCameraStaysInItsPlace) {
    const PosedCamera whole = make_frame_cameras(Shot(at({1, 2, 3}, 0.3)).frame).color;
    const PosedCamera half = resized(whole, {8, 6});
    EXPECT_EQ(half.gpu.extent, glm::uvec2(8, 6));
    EXPECT_EQ(half.gpu.camera_from_world, whole.gpu.camera_from_world);
    EXPECT_EQ(half.intrinsics.fx, 9);
    EXPECT_EQ(half.gpu.focal_center_px.x, 9);
}

TEST(FrameContext, TheFirstFrameHasNoMotionTheNextOneThatOfTheColourCamera) {
    Shot first(at({0, 0, 0})), second(at({0.1, 0, 0}));
    second.frame.shutter_share = 0.25f;
    FrameHistory history;
    const FrameContext before = make_frame_context(first.frame, history, {}, true);
    EXPECT_FALSE(before.motion);
    history.note(before);
    const FrameContext after = make_frame_context(second.frame, history, {}, true);
    ASSERT_TRUE(after.motion);
    EXPECT_EQ(after.motion->color_before_from_world, before.color.gpu.camera_from_world);
    EXPECT_EQ(after.motion->shutter_share, 0.25f);
}

TEST(FrameContext, HeldOutFramesCountButNotTheirColours) {
    Shot shot;
    FrameHistory history;
    for (const bool held_out : {false, true, false}) {
        shot.frame.held_out = held_out;
        const FrameContext context = make_frame_context(shot.frame, history, {}, true);
        EXPECT_EQ(context.fuses_color, !held_out);
        EXPECT_EQ(context.held_out, held_out);
        history.note(context);
    }
    EXPECT_EQ(history.frames, 3u);
    EXPECT_EQ(history.color_frames, 2u);
    const FrameContext last = make_frame_context(shot.frame, history, {}, true);
    EXPECT_EQ(last.index, 3u);
    EXPECT_EQ(last.color_index, 2u);
    EXPECT_FALSE(make_frame_context(shot.frame, history, {}, false).fuses_color) << "of a model without colours";
}

TEST(FrameContext, TheFirstFrameOfEachKindLooksWithEveryPixelLaterOnesWithFew) {
    const DepthRange range{0.3f, 8.2f, 8};  // a usual depth of 3 m, where a pixel covers 1/3 m
    const Shot shot;
    FrameHistory history;
    for (const bool precedes : {true, false}) {
        for (int i = 0; i < 3; ++i) {
            FrameContext context = make_frame_context(shot.frame, history, range, true);
            context.precedes = precedes;
            EXPECT_EQ(context.first(), i == 0) << precedes << " " << i;
            EXPECT_EQ(context.stride_px(2, 10), i == 0 ? 1u : 2u) << precedes << " " << i;
            history.note(context);
        }
    }
    const FrameContext later = make_frame_context(shot.frame, history, range, true);
    EXPECT_EQ(later.stride_px(4, 1.1), 3u) << "as many as leave out no cell";
    EXPECT_EQ(later.stride_px(4, 0.01), 1u) << "pixels are farther apart than cells";
    EXPECT_EQ(later.stride_px(0, 10), 1u);
    const FrameContext near = make_frame_context(shot.frame, history, {0.3f, 2.1f, 2}, true);
    EXPECT_EQ(near.stride_px(8, 0.5), 6u) << "what is near is seen by more pixels";
}

TEST(FrameContext, RangeAndLabelsAreTheFramesOwn) {
    Shot shot;
    const std::vector<uint16_t> labels(kDepthCamera.extent.area(), 3);
    shot.frame.labels = labels;
    const FrameContext context = make_frame_context(shot.frame, {}, {0.3f, 4.5f, 4}, true);
    EXPECT_EQ(context.range.near_m, 0.3f);
    EXPECT_EQ(context.range.far_m, 4.5f);
    EXPECT_EQ(context.range.reach_m, 4);
    EXPECT_EQ(context.labels.data(), labels.data());
}

std::string refusal_of(const RgbdFrame& frame) {
    try {
        check_frame(frame, 7);
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

TEST(FrameContext, FramesThatCannotBeAreRefused) {
    EXPECT_EQ(refusal_of(Shot().frame), "");
    Shot small_depth, small_color, few_labels, skewed;
    small_depth.depth.pop_back();
    small_depth.frame.depth.pixels = std::span<const float>(small_depth.depth);
    EXPECT_EQ(refusal_of(small_depth.frame), "the depth picture has 47 pixels, its camera 8 x 6");
    small_color.color.pop_back();
    small_color.frame.color.pixels = std::span<const glm::vec3>(small_color.color);
    EXPECT_EQ(refusal_of(small_color.frame), "the colour picture has 191 pixels, its camera 16 x 12");
    const std::vector<uint16_t> labels(3);
    few_labels.frame.labels = labels;
    EXPECT_EQ(refusal_of(few_labels.frame), "the label picture has 3 pixels, the depth camera 8 x 6");
    skewed.frame.world_from_depth[0][0] = 1.01;
    EXPECT_THAT(refusal_of(skewed.frame), ::testing::StartsWith("the pose of frame 7 is not rigid"));
}

}  // namespace
}  // namespace patina::frame_context_test
