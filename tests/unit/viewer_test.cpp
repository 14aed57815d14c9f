// What the viewer computes without a device: its camera, the handles of lamps, layers, and how much it draws.

#include <numbers>

#include <gtest/gtest.h>

#include "tests/export/temporary_folder.h"
#include "tools/program/free_place.h"
#include "tools/viewer/draw_budget.h"
#include "tools/viewer/frame_times.h"
#include "tools/viewer/free_camera.h"
#include "tools/viewer/layers.h"
#include "tools/viewer/light_handles.h"

namespace patina::tools::viewer_test {
namespace {

constexpr double kExact = 1e-9;
const Intrinsics kCamera{{640, 480}, 500, 500, 319.5, 239.5, {}};

void expect_near(glm::dvec3 got, glm::dvec3 expected) {
    EXPECT_LT(glm::distance(got, expected), kExact) << got.x << ' ' << got.y << ' ' << got.z;
}

/// A camera with y down that looks along z, 2 m before the point that it turns around.
FreeCamera facing() {
    FreeCamera camera;
    camera.set_up({0, -1, 0}, {0, 0, 1});
    camera.look_from(RigidTransform(1.0), 2);
    return camera;
}

TEST(FreeCamera, LooksFromAPoseAsItDoes) {
    const FreeCamera camera = facing();
    expect_near(camera.pivot_m(), {0, 0, 2});
    for (int axis = 0; axis < 4; ++axis) expect_near(glm::dvec3(camera.pose()[axis]), glm::dvec3(glm::dmat4(1)[axis]));
}

TEST(FreeCamera, LeavesOutTheRollOfAPose) {
    RigidTransform rolled(1.0);
    rolled[0] = {0, 1, 0, 0};
    rolled[1] = {-1, 0, 0, 0};
    FreeCamera camera = facing();
    camera.look_from(rolled, 2);
    expect_near(glm::dvec3(camera.pose()[0]), {1, 0, 0});
    expect_near(glm::dvec3(camera.pose()[2]), {0, 0, 1});
}

TEST(FreeCamera, TurnsAroundItsPointAndKeepsItInTheMiddle) {
    FreeCamera camera = facing();
    camera.orbit({90 / 0.4, 0});  // the mouse goes right: the camera goes to the left of the scene
    expect_near(glm::dvec3(camera.pose()[3]), {-2, 0, 2});
    camera.orbit({-90 / 0.4, 30 / 0.4});
    const glm::dvec3 center(camera.pose()[3]);
    EXPECT_LT(center.y, -0.9) << "the mouse goes down: the camera goes up";
    EXPECT_NEAR(glm::distance(center, camera.pivot_m()), 2, kExact);
    expect_near(center + 2.0 * glm::dvec3(camera.pose()[2]), camera.pivot_m());
    EXPECT_LT(rotation_defect(camera.pose()), kExact);
}

TEST(FreeCamera, OverThePoleItsAxesStayARotation) {
    FreeCamera camera = facing();
    for (int i = 0; i < 40; ++i) {
        camera.orbit({3, 11});
        ASSERT_LT(rotation_defect(camera.pose()), kExact) << i;
    }
}

TEST(FreeCamera, PannedItsPointFollowsTheMouse) {
    FreeCamera camera = facing();
    const glm::dvec3 before = camera.pivot_m();
    camera.pan({25, -10}, kCamera.fx);
    const auto at = appears_at(kCamera, camera.pose(), before);
    ASSERT_TRUE(at);
    EXPECT_NEAR(at->x, kCamera.cx + 25, kExact);
    EXPECT_NEAR(at->y, kCamera.cy - 10, kExact);
}

TEST(FreeCamera, ComesNearerWithinLimits) {
    FreeCamera camera = facing();
    camera.dolly(1);
    EXPECT_NEAR(camera.distance_m(), 2 / 1.2, kExact);
    camera.dolly(-1);
    EXPECT_NEAR(camera.distance_m(), 2, kExact);
    camera.dolly(1000);
    EXPECT_EQ(camera.distance_m(), FreeCamera::kLeastDistance_m);
    camera.dolly(-1000);
    EXPECT_EQ(camera.distance_m(), FreeCamera::kMostDistance_m);
}

TEST(FreeCamera, ViewsAlongTheAxes) {
    FreeCamera camera = facing();
    const auto forward = [&](AxisView view) {
        camera.look_along(view);
        return glm::dvec3(camera.pose()[2]);
    };
    expect_near(forward(AxisView::kFront), {0, 0, 1});
    expect_near(forward(AxisView::kBack), {0, 0, -1});
    expect_near(forward(AxisView::kRight), {-1, 0, 0});
    expect_near(forward(AxisView::kLeft), {1, 0, 0});
    expect_near(forward(AxisView::kTop), {0, 1, 0});
    expect_near(forward(AxisView::kBottom), {0, -1, 0});
    camera.opposite();
    expect_near(glm::dvec3(camera.pose()[2]), {0, 1, 0});
}

TEST(FreeCamera, AWindowOfAnotherShapeSeesAsMuchFromTopToBottom) {
    const Intrinsics wide = with_extent(kCamera, {1280, 240});
    EXPECT_EQ(wide.fy, 250);
    EXPECT_EQ(wide.cx, 639.5);
    EXPECT_EQ(wide.cy, 119.5);
}

TEST(LightHandles, TheNearestOneIsTakenAndGoesWhereTheMouseGoes) {
    const std::vector<Light> lights{
        {{0, 0, 2}, glm::dvec3(1)}, {{0.1, 0, 2}, glm::dvec3(1)}, {{0, 0, -2}, glm::dvec3(1)}};
    const RigidTransform pose(1.0);
    EXPECT_EQ(light_at(lights, kCamera, pose, {320, 240}, 10), 0u) << "not the one behind the camera";
    EXPECT_EQ(light_at(lights, kCamera, pose, {340, 240}, 10), 1u);
    EXPECT_EQ(light_at(lights, kCamera, pose, {400, 240}, 10), std::nullopt);
    const glm::dvec3 moved = dragged(lights[0].position_m, kCamera, pose, {50, 20});
    expect_near(moved, {0.2, 0.08, 2});
    const glm::dvec3 nearer = pushed(moved, pose, 1);
    EXPECT_NEAR(nearer.z, 2 * 11.0 / 12, kExact);
    EXPECT_EQ(appears_at(kCamera, pose, moved), appears_at(kCamera, pose, nearer)) << "along the line of sight";
}

TEST(Layers, EachHasItsWordAndIsThereWhereTheModelHasIt) {
    for (size_t i = 0; i < kLayers.size(); ++i) EXPECT_EQ(static_cast<size_t>(kLayers[i].layer), i);
    EXPECT_TRUE(has_layer(Layer::kNormals, false, false));
    EXPECT_FALSE(has_layer(Layer::kKd, false, true));
    EXPECT_FALSE(has_layer(Layer::kSegments, true, false));
    EXPECT_TRUE(has_layer(Layer::kCoverage, true, false));
}

TEST(Layers, TheScaleRunsFromDarkToBrightAndIsClipped) {
    EXPECT_EQ(scale_color(-1), scale_color(0));
    EXPECT_EQ(scale_color(2), scale_color(1));
    float before = 0;
    for (int i = 0; i <= 20; ++i) {
        const glm::vec3 color = scale_color(static_cast<float>(i) / 20);
        const float brightness = 0.2126f * color.r + 0.7152f * color.g + 0.0722f * color.b;
        EXPECT_GT(brightness, before) << i;
        before = brightness;
    }
}

TEST(Layers, OnlyRadianceIsExposed) {
    EXPECT_EQ(params_of(Layer::kColor, glm::dvec3(0), 3).exposure, 3);
    EXPECT_EQ(params_of(Layer::kKd, glm::dvec3(0), 3).exposure, 1);
    EXPECT_EQ(params_of(Layer::kAlpha, glm::dvec3(0), 3).channel, 3u);
    EXPECT_EQ(params_of(Layer::kCoverage, glm::dvec3(0), 3).high, 30);
}

TEST(DrawBudget, TakesItsShareOfTheTimeWhateverAPictureCosts) {
    for (const double cost_s : {0.001, 0.02, 0.3}) {
        DrawBudget budget(0.1);
        double now_s = 5, drawn_s = 0;
        while (now_s < 100) {
            if (budget.due(now_s)) {
                budget.spend(now_s, cost_s);
                drawn_s += cost_s;
                now_s += cost_s;
            }
            now_s += 0.001;
        }
        EXPECT_LE(drawn_s, 0.1 * 95 + cost_s);
        EXPECT_GT(drawn_s, 0.1 * 95 / 2) << "and makes use of it, with pictures of " << cost_s << " s";
    }
}

/// While a run is paused, pictures are drawn one after the other. It would be ten times as long until the next one.
TEST(DrawBudget, APauseCostsNothingAfterwards) {
    DrawBudget budget(0.1);
    double now_s = 0;
    for (int i = 0; i < 100; ++i, now_s += 0.1) budget.spend(now_s, 0.1);
    EXPECT_FALSE(budget.due(now_s + 80));
    budget.forgive(now_s);
    EXPECT_TRUE(budget.due(now_s));
    budget.spend(now_s, 0.1);
    EXPECT_FALSE(budget.due(now_s + 0.9));
    EXPECT_TRUE(budget.due(now_s + 1.1));
}

TEST(DrawBudget, SlowPicturesGetSmallerAndFastOnesLargeAgain) {
    DrawBudget budget(1);
    const Extent2D window{1280, 801};
    EXPECT_EQ(budget.picture_extent(window), window);
    budget.spend(0, 0.2);
    EXPECT_EQ(budget.picture_extent(window), (Extent2D{640, 400}));
    for (int i = 0; i < 10; ++i) budget.spend(0, 0.2);
    EXPECT_EQ(budget.picture_extent(window), (Extent2D{160, 100}));
    EXPECT_EQ(budget.picture_extent({4, 2}), (Extent2D{1, 1}));
    budget.spend(0, 0.02);
    EXPECT_EQ(budget.picture_extent(window), (Extent2D{160, 100})) << "four times that would be slow";
    for (int i = 0; i < 10; ++i) budget.spend(0, 0.001);
    EXPECT_EQ(budget.picture_extent(window), window);
}

TEST(FreePlace, IsOneThatIsNotThere) {
    const test::TemporaryFolder folder;
    const std::filesystem::path run = folder / "room";
    EXPECT_EQ(free_place_beside(run / "", "export"), folder / "room-export-1");
    std::filesystem::create_directory(folder / "room-export-1");
    EXPECT_EQ(free_place_beside(run, "export"), folder / "room-export-2");
}

TEST(FrameTimes, AreMeansOverTheLastFramesAndLeaveOutPauses) {
    FrameTimes times;
    EXPECT_EQ(times.interval_ms(), 0);
    std::vector<graph::Timing> passes{{"track", {100}}, {"fuse", {100}}};
    times.fused(5, passes);  // pipelines were built
    EXPECT_EQ(times.device_ms(), 0);
    for (int i = 1; i <= 40; ++i) {
        passes[0].samples_ms.insert(passes[0].samples_ms.end(), {2, 1});  // twice a frame
        passes[1].samples_ms.push_back(i <= 10 ? 50 : 4);
        times.fused(5 + 0.1 * i, passes);
    }
    EXPECT_NEAR(times.interval_ms(), 100, 1e-6);
    EXPECT_NEAR(times.device_ms(), 7, 1e-6);
    times.paused();
    times.fused(1000, passes);
    EXPECT_NEAR(times.interval_ms(), 100, 1e-6);
}

}  // namespace
}  // namespace patina::tools::viewer_test
