// Windows among the cells of what is around.

#include "reconstruction/lights/find_windows.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <span>
#include <vector>

#include <glm/gtc/constants.hpp>
#include <gmock/gmock.h>

namespace patina::find_windows_test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr double kCell_m = double{gpu::kSurroundingsCellM};
constexpr double kGrid_m = 0.01;

gpu::SurroundingsSums sums_of(glm::dvec3 radiance, uint32_t samples) {
    const glm::uvec3 steps(radiance * double(samples) * double{gpu::kSurroundingsSteps} + 0.5);
    return {samples, steps.r, steps.g, steps.b};
}

/// Points of surfaces and of openings on a grid of a centimetre, added to the cells that they lie in.
class Surroundings {
  public:
    /// A rectangle about `center_m`, as usual exposure shows it, or low exposure, too.
    void add(glm::dvec3 center_m, glm::dvec3 half_u_m, glm::dvec3 half_v_m, bool opens, glm::dvec3 usual,
             glm::dvec3 low = glm::dvec3(0)) {
        const int columns = int(2 * glm::length(half_u_m) / kGrid_m), rows = int(2 * glm::length(half_v_m) / kGrid_m);
        for (int y = 0; y < rows; ++y) {
            for (int x = 0; x < columns; ++x) {
                const double u = 2 * (x + 0.5) / columns - 1, v = 2 * (y + 0.5) / rows - 1;
                const glm::dvec3 cell = glm::floor((center_m + u * half_u_m + v * half_v_m) / kCell_m);
                Sums& sums = cells_[{int(cell.x), int(cell.y), int(cell.z)}];
                ++sums.points;
                sums.openings += opens ? 1 : 0;
                sums.usual += usual;
                sums.low += low;
            }
        }
    }

    /// Each cell with a sample a point, of low exposure too where that shows anything; free places between.
    std::vector<gpu::SurroundingsCell> table() const {
        std::vector<gpu::SurroundingsCell> all;
        for (const auto& [at, sums] : cells_) {
            const auto low10 = [](int v) { return static_cast<uint32_t>(v) & 1023u; };
            gpu::SurroundingsCell cell{};
            cell.key = low10(at[0]) | low10(at[1]) << 10 | low10(at[2]) << 20 | 0x80000000u;
            const bool has_low = sums.low != glm::dvec3(0);
            cell.openings = (has_low ? 2 : 1) * sums.openings;
            cell.light.usual = sums_of(sums.usual / double(sums.points), sums.points);
            if (has_low) cell.light.low = sums_of(sums.low / double(sums.points), sums.points);
            all.push_back(cell);
            all.push_back({});
        }
        return all;
    }

  private:
    struct Sums {
        uint32_t points = 0, openings = 0;
        glm::dvec3 usual{0}, low{0};
    };
    std::map<std::array<int, 3>, Sums> cells_;
};

double angle_deg(glm::dvec3 a, glm::dvec3 b) {
    return glm::degrees(std::acos(glm::clamp(glm::dot(glm::normalize(a), glm::normalize(b)), -1.0, 1.0)));
}

class FindWindows : public testing::Test {
  protected:
    FindWindows() { room_.add({0, 0, -1}, {2, 0, 0}, {0, 2, 0}, false, glm::dvec3(0.2)); }

    /// In a wall that is turned by this angle about the vertical, 2 m from the origin.
    void add_window(double turned_deg, double along_m, glm::dvec2 half_m, glm::dvec3 usual, glm::dvec3 low) {
        const double angle = glm::radians(turned_deg);
        const glm::dvec3 out(std::cos(angle), std::sin(angle), 0), along(-std::sin(angle), std::cos(angle), 0);
        room_.add(2.0 * out + along_m * along, half_m.x * along, {0, 0, half_m.y}, true, usual, low);
    }

    std::vector<AreaLight> found(std::span<const Light> lamps = {}) const {
        return find_windows(room_.table(), glm::dvec3(0), lamps);
    }

    Surroundings room_;
};

TEST_F(FindWindows, OneIsWhereItIsAndShinesIntoTheRoomWhicheverWayItsWallIsTurned) {
    for (const double turned_deg : {0.0, 27.0, 45.0, 170.0, -98.0}) {
        room_ = Surroundings();
        room_.add({0, 0, -1}, {2, 0, 0}, {0, 2, 0}, false, glm::dvec3(0.2));
        add_window(turned_deg, 0.3, {0.6, 0.4}, glm::dvec3(0.95), {3, 4, 6});
        const std::vector<AreaLight> windows = found();
        ASSERT_THAT(windows, SizeIs(1)) << turned_deg;
        const AreaLight& window = windows.front();
        const double angle = glm::radians(turned_deg);
        const glm::dvec3 out(std::cos(angle), std::sin(angle), 0), along(-std::sin(angle), std::cos(angle), 0);
        EXPECT_LT(glm::distance(window.center_m, 2.0 * out + 0.3 * along), 0.04) << turned_deg;
        EXPECT_LT(angle_deg(normal_of(window), -out), 4) << turned_deg;
        const double u = glm::length(window.half_u_m), v = glm::length(window.half_v_m);
        EXPECT_NEAR(std::max(u, v), 0.6, 0.04) << turned_deg;
        EXPECT_NEAR(std::min(u, v), 0.4, 0.04) << turned_deg;
        EXPECT_NEAR(glm::dot(window.half_u_m, window.half_v_m), 0, 1e-9);
        EXPECT_LT(glm::distance(window.radiance, {3, 4, 6}), 1e-2) << "as low exposure shows it";
        EXPECT_FALSE(window.clipped);
    }
}

TEST_F(FindWindows, OneIsWhereCamerasWereHoweverFarFromTheOrigin) {
    for (const glm::dvec3 middle_m : {glm::dvec3(100, -300, 0), glm::dvec3(24.5, -25.7, 51.2)}) {
        room_ = Surroundings();
        room_.add(middle_m - glm::dvec3(0, 0, 1), {2, 0, 0}, {0, 2, 0}, false, glm::dvec3(0.2));
        room_.add(middle_m + glm::dvec3(2, 0, 0), {0, 0.6, 0}, {0, 0, 0.4}, true, glm::dvec3(0.9), glm::dvec3(3));
        const std::vector<AreaLight> windows = find_windows(room_.table(), middle_m + glm::dvec3(0.3, -0.5, 0.2));
        ASSERT_THAT(windows, SizeIs(1));
        EXPECT_LT(glm::distance(windows[0].center_m, middle_m + glm::dvec3(2, 0, 0)), 0.04);
        EXPECT_LT(angle_deg(normal_of(windows[0]), {-1, 0, 0}), 4);
    }
}

TEST_F(FindWindows, SurfacesNearItTellWhichSideIsInside) {
    room_.add({8, 0, -1}, {4, 0, 0}, {0, 4, 0}, false, glm::dvec3(0.2));  // a larger room behind its wall
    add_window(0, 0, {0.5, 0.4}, glm::dvec3(0.9), glm::dvec3(3));
    room_.add({0, 0, 1}, {2, 0, 0}, {0, 2, 0}, false, glm::dvec3(0.2));
    const std::vector<AreaLight> windows = find_windows(room_.table(), {8, 0, 0});  // most cameras were there, too
    ASSERT_THAT(windows, SizeIs(1));
    EXPECT_LT(normal_of(windows[0]).x, -0.95);
}

TEST_F(FindWindows, InAWallAloneCamerasTellWhichSideIsInside) {
    room_ = Surroundings();
    room_.add({2, 1.5, 0}, {0, 0.5, 0}, {0, 0, 1}, false, glm::dvec3(0.2));
    add_window(0, 0, {0.5, 0.4}, glm::dvec3(0.9), glm::dvec3(3));
    for (const double x_m : {0.0, 4.0}) {
        const std::vector<AreaLight> windows = find_windows(room_.table(), {x_m, 0, 0});
        ASSERT_THAT(windows, SizeIs(1));
        EXPECT_LT(angle_deg(normal_of(windows[0]), {x_m < 2 ? -1 : 1, 0, 0}), 4);
    }
}

TEST_F(FindWindows, ALampIsNone) {
    add_window(0, 0, {0.2, 0.2}, glm::dvec3(0.95), glm::dvec3(3));
    EXPECT_THAT(found(), SizeIs(1));
    const Light lamp{{2, 0, 0}, glm::dvec3(1), 0.3}, other{{-2, 0, 0}, glm::dvec3(1), 0.3};
    EXPECT_THAT(found({&lamp, 1}), IsEmpty());
    EXPECT_THAT(found({&other, 1}), SizeIs(1));
}

TEST_F(FindWindows, OneOfWhichAPartIsClippedIsAtLeastSoBright) {
    add_window(0, 0, {0.5, 0.4}, glm::dvec3(0.95), glm::dvec3(3));
    EXPECT_FALSE(found().front().clipped);
    room_.add({2, 0.65, 0}, {0, 0.15, 0}, {0, 0, 0.4}, true, glm::dvec3(1));  // no low exposure shows this part
    ASSERT_THAT(found(), SizeIs(1));
    EXPECT_TRUE(found().front().clipped);
}

TEST_F(FindWindows, WithoutLowExposureAClippedOneIsAtLeastSoBright) {
    add_window(0, 0, {0.5, 0.5}, glm::dvec3(1), glm::dvec3(0));
    ASSERT_THAT(found(), SizeIs(1));
    EXPECT_TRUE(found().front().clipped);
    EXPECT_NEAR(found().front().radiance.g, 1, 1e-2);
}

TEST_F(FindWindows, ADimOneIsOneWhereLowExposureShowsIt) {
    add_window(0, 0, {0.5, 0.5}, {0.3, 0.4, 0.5}, {0.3, 0.4, 0.5});
    ASSERT_THAT(found(), SizeIs(1));
    EXPECT_FALSE(found().front().clipped);
    room_ = Surroundings();
    room_.add({0, 0, -1}, {2, 0, 0}, {0, 2, 0}, false, glm::dvec3(0.2));
    add_window(0, 0, {0.5, 0.5}, {0.3, 0.4, 0.5}, glm::dvec3(0));
    EXPECT_THAT(found(), IsEmpty()) << "it may be a sink of steel, which gave no depth";
}

TEST_F(FindWindows, PanesThatDoNotTouchAreOneEachTheLargestFirst) {
    add_window(0, -0.5, {0.3, 0.4}, glm::dvec3(0.9), glm::dvec3(2));
    add_window(0, 0.5, {0.5, 0.4}, glm::dvec3(0.9), glm::dvec3(5));
    const std::vector<AreaLight> windows = found();
    ASSERT_THAT(windows, SizeIs(2));
    EXPECT_NEAR(windows[0].radiance.r, 5, 1e-2);
    EXPECT_NEAR(windows[1].radiance.r, 2, 1e-2);
}

TEST_F(FindWindows, GapsThatAreDarkerThanSurfacesAreNone) {
    add_window(0, 0, {0.5, 0.5}, glm::dvec3(0.15), glm::dvec3(0));
    EXPECT_THAT(found(), IsEmpty());
}

TEST_F(FindWindows, SmallOnesAndWhatFillsNoRectangleAreNone) {
    add_window(0, 0, {0.05, 0.05}, glm::dvec3(0.9), glm::dvec3(2));
    room_.add({2, 0, 0.8}, {0, 0.5, 0.5}, {0, 0.02, -0.02}, true, glm::dvec3(0.9), glm::dvec3(2));  // two strips
    room_.add({2, 0, 0.8}, {0, 0.5, -0.5}, {0, 0.02, 0.02}, true, glm::dvec3(0.9), glm::dvec3(2));  // that cross
    EXPECT_THAT(found(), IsEmpty());
}

TEST_F(FindWindows, ANarrowStripIsNone) {
    add_window(0, 0, {0.02, 0.9}, glm::dvec3(0.9), glm::dvec3(2));
    EXPECT_THAT(found(), IsEmpty());
}

TEST_F(FindWindows, WhatIsAsDeepAsWideIsNone) {
    for (int layer = 0; layer < 10; ++layer)
        room_.add({2 + 0.05 * layer, 0, 0}, {0, 0.25, 0}, {0, 0, 0.25}, true, glm::dvec3(0.9), glm::dvec3(2));
    EXPECT_THAT(found(), IsEmpty());
}

TEST_F(FindWindows, OrderInTheTableDoesNotMatter) {
    add_window(30, -0.5, {0.3, 0.4}, glm::dvec3(0.9), {2.3, 1.7, 0.9});
    add_window(30, 0.5, {0.5, 0.4}, glm::dvec3(0.9), {5.1, 1.3, 0.7});
    std::vector<gpu::SurroundingsCell> table = room_.table();
    const std::vector<AreaLight> windows = find_windows(table, glm::dvec3(0));
    std::ranges::reverse(table);
    EXPECT_EQ(find_windows(table, glm::dvec3(0)), windows);
}

TEST_F(FindWindows, NothingAroundIsNoWindow) {
    EXPECT_THAT(find_windows({}, glm::dvec3(0)), IsEmpty());
    EXPECT_THAT(find_windows(std::vector<gpu::SurroundingsCell>(8), glm::dvec3(0)), IsEmpty());
    EXPECT_THAT(found(), IsEmpty());
}

}  // namespace
}  // namespace patina::find_windows_test
