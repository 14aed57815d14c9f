#include "tools/eval/seen_surface.h"

#include <random>

#include <gtest/gtest.h>

#include "tests/eval/sliding_view.h"

namespace patina::eval::seen_surface_test {
namespace {

using test::SlidingView;

constexpr Extent2D kExtent = SlidingView::kExtent;

/// Calls visit(x, y) for every pixel.
template <class Visit>
void for_each_pixel(Visit visit) {
    for (uint32_t y = 0; y < kExtent.height; ++y) {
        for (uint32_t x = 0; x < kExtent.width; ++x) visit(x, y);
    }
}

TEST(SeenSurface, CountsTheFramesThatHadAPointInTheirPicture) {
    constexpr uint32_t kLeast = 3, kFrames = 8;
    SeenSurface surface(kLeast);
    for (uint32_t frame = 0; frame < kFrames; ++frame) {
        for_each_pixel([&](uint32_t x, uint32_t y) { surface.add(SlidingView::point(x, y, frame)); });
    }
    for (uint32_t frame = 0; frame < kFrames; ++frame) surface.count(frame, SlidingView::view(frame));
    for (uint32_t frame = 0; frame < kFrames; ++frame) {
        for_each_pixel([&](uint32_t x, uint32_t y) {
            const uint32_t before = std::min(frame, (kExtent.width - 1 - x) / SlidingView::kStep);
            EXPECT_EQ(surface.is_seen(SlidingView::point(x, y, frame), frame), before + 1 >= kLeast)
                << x << ' ' << y << " in frame " << frame;
        });
    }
}

TEST(SeenSurface, WhatLiesBehindSomethingIsNotSeen) {
    // The wall from two places, columns 20 to 25 being hidden by a board in front.
    SeenSurface surface(1);
    for_each_pixel([&](uint32_t x, uint32_t y) { surface.add(SlidingView::point(x, y, 0)); });
    DepthView view = SlidingView::view(0);
    for_each_pixel([&](uint32_t x, uint32_t y) {
        if (x >= 20 && x <= 25) view.depth_m.at(x, y) = 1;
    });
    surface.count(0, view);
    for_each_pixel([&](uint32_t x, uint32_t y) {
        if (x == 20 || x == 25) return;  // between readings of both
        EXPECT_EQ(surface.is_seen(SlidingView::point(x, y, 0), 0), x < 20 || x > 25) << x << ' ' << y;
    });
}

TEST(SeenSurface, AReadingElsewhereOrNoneCountsNothing) {
    SeenSurface surface(1);
    for_each_pixel([&](uint32_t x, uint32_t y) { surface.add(SlidingView::point(x, y, 0)); });
    for (const float depth_m : {0.0f, SlidingView::kWall_m - 0.03f, SlidingView::kWall_m + 0.03f}) {
        surface.count(0, {Image<float>(kExtent, depth_m), SlidingView::camera(), SlidingView::world_from_camera(0)});
    }
    DepthView behind = SlidingView::view(0);
    behind.world_from_camera[3].z = 2 * SlidingView::kWall_m;
    surface.count(0, behind);
    for_each_pixel([&](uint32_t x, uint32_t y) { EXPECT_FALSE(surface.is_seen(SlidingView::point(x, y, 0), 0)); });
    surface.count(1, {Image<float>(kExtent, SlidingView::kWall_m - 0.01f), SlidingView::camera(),
                      SlidingView::world_from_camera(0)});
    for_each_pixel([&](uint32_t x, uint32_t y) { EXPECT_TRUE(surface.is_seen(SlidingView::point(x, y, 0), 1)); });
}

/// A floor 1 m below a camera that looks ahead; its last rows are metres apart.
DepthView floor_view(double turn_px, uint32_t seed) {
    DepthView view{Image<float>(kExtent), SlidingView::camera(), RigidTransform(1)};
    view.camera.cx += turn_px;
    view.camera.cy += turn_px;
    std::mt19937 generator(seed);
    std::normal_distribution<double> noise_m(0, 0.003);
    for_each_pixel([&](uint32_t x, uint32_t y) {
        const double down = (y - view.camera.cy) / view.camera.fy;
        if (down > 0.02) view.depth_m.at(x, y) = static_cast<float>(1 / down + noise_m(generator));
    });
    return view;
}

TEST(SeenSurface, GrazingSurfacesHaveNoGaps) {
    constexpr uint32_t kLeast = 5;
    SeenSurface surface(kLeast);
    std::vector<glm::dvec3> points;
    const DepthView first = floor_view(0, 0);
    // The rows and columns at the rim leave the picture as it moves.
    for_each_pixel([&](uint32_t x, uint32_t y) {
        const double down = (y - first.camera.cy) / first.camera.fy;
        if (x == 0 || x + 1 >= kExtent.width || y + 1 >= kExtent.height || down < 0.05) return;
        points.push_back({(x - first.camera.cx) / first.camera.fx / down, 1, 1 / down});
        surface.add(points.back());
    });
    ASSERT_GT(points.size(), 700u);
    for (uint32_t frame = 0; frame < kLeast; ++frame) surface.count(frame, floor_view(0.2 * frame, frame));
    for (const glm::dvec3& point : points) {
        EXPECT_FALSE(surface.is_seen(point, kLeast - 2));
        EXPECT_TRUE(surface.is_seen(point, kLeast - 1)) << point.x << ' ' << point.z;
    }
}

}  // namespace
}  // namespace patina::eval::seen_surface_test
