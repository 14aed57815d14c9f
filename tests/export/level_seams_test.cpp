// Charts that differ where they meet are brought to the same albedo.

#include "export/atlas/level_seams.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include <gtest/gtest.h>

#include "export/atlas/find_seams.h"
#include "export/atlas/lay_out_texture.h"

namespace patina::level_seams_test {
namespace {

constexpr double kTexel_m = 0.002;
constexpr uint32_t kQuads = 20;  // along the side of a wall, of 1 cm each

/// Along the surface from the corner, and up. Walls have u below and above 0.
using Place = glm::dvec2;

/// Two walls of 20 x 20 cm that meet at a right angle; or, with `open`, one.
TextureLayout corner(bool open = false) {
    TidyPiece piece;
    const int from = open ? 0 : -static_cast<int>(kQuads);
    const uint32_t row = open ? kQuads + 1 : 2 * kQuads + 1;
    for (uint32_t v = 0; v <= kQuads; ++v) {
        for (int u = from; u <= static_cast<int>(kQuads); ++u) {
            const float along_m = 0.01f * static_cast<float>(u), up_m = 0.01f * static_cast<float>(v);
            piece.mesh.positions_m.emplace_back(std::min(along_m, 0.0f), up_m, std::max(along_m, 0.0f));
            piece.mesh.normals.push_back(glm::normalize(glm::vec3(u < 0 ? 0 : -1, 0, u > 0 ? 0 : 1)));
            piece.mesh.colors.emplace_back(0.5f);
        }
    }
    for (uint32_t v = 0; v < kQuads; ++v) {
        for (uint32_t u = 0; u + 1 < row; ++u) {
            const uint32_t i = v * row + u;
            piece.mesh.triangles.push_back({i, i + 1, i + row});
            piece.mesh.triangles.push_back({i + 1, i + row + 1, i + row});
        }
    }
    return lay_out_texture({std::move(piece)}, {.texel_m = kTexel_m});
}

/// Where texels of a flat chart lie on the surface.
class FlatChart {
  public:
    FlatChart(const TextureLayout& layout, const TextureBox& box) {
        const TexturedSurface& surface = layout.pieces[0];
        const auto in_box = [&](uint32_t vertex) {
            const glm::uvec2 texel(surface.place_px[vertex]);
            return glm::all(glm::greaterThanEqual(texel, box.low)) && glm::all(glm::lessThan(texel, box.high));
        };
        const auto& t =
            *std::ranges::find_if(surface.mesh.triangles, [&](const auto& triangle) { return in_box(triangle[0]); });
        origin_px_ = surface.place_px[t[0]];
        origin_ = place(surface.mesh.positions_m[t[0]]);
        const glm::dmat2 px(glm::dvec2(surface.place_px[t[1]]) - origin_px_,
                            glm::dvec2(surface.place_px[t[2]]) - origin_px_);
        const glm::dmat2 there(place(surface.mesh.positions_m[t[1]]) - origin_,
                               place(surface.mesh.positions_m[t[2]]) - origin_);
        place_per_px_ = there * glm::inverse(px);
        double low = 1, high = -1;
        for (uint32_t v = 0; v < surface.place_px.size(); ++v) {
            if (!in_box(v)) continue;
            low = std::min(low, place(surface.mesh.positions_m[v]).x);
            high = std::max(high, place(surface.mesh.positions_m[v]).x);
        }
        left = low + high < 0;
    }

    Place at(glm::dvec2 px) const { return origin_ + place_per_px_ * (px - origin_px_); }
    glm::dvec2 px_of(Place place) const { return origin_px_ + glm::inverse(place_per_px_) * (place - origin_); }

    bool left;  ///< u is below 0

  private:
    static Place place(glm::vec3 position_m) { return {double{position_m.x} + double{position_m.z}, position_m.y}; }

    glm::dvec2 origin_px_{0};
    Place origin_{0};
    glm::dmat2 place_per_px_{1};
};

struct Painted {
    TextureLayout layout;
    std::vector<TexturePage> pages;
    std::vector<FlatChart> charts;  ///< by box

    Painted(TextureLayout of, const std::function<double(const FlatChart&, Place)>& root) : layout(std::move(of)) {
        for (const Extent2D page : layout.pages) pages.push_back({Image<glm::vec3>(page), Image<TexelState>(page)});
        for (const TextureBox& box : layout.boxes) {
            const FlatChart& chart = charts.emplace_back(layout, box);
            for (uint32_t y = box.low.y; y < box.high.y; ++y) {
                for (uint32_t x = box.low.x; x < box.high.x; ++x) {
                    const double r = root(chart, chart.at(glm::dvec2(x, y) + 0.5));
                    pages[box.page].kd.at(x, y) = glm::vec3(static_cast<float>(r * r));
                    pages[box.page].states.at(x, y) = TexelState::kSeen;
                }
            }
        }
    }

    void level() { level_seams(layout, pages); }

    /// The square root of the albedo, between texels, as the left or the right wall shows it.
    double root_at(bool left, Place place) const {
        for (size_t i = 0; i < charts.size(); ++i)
            if (charts[i].left == left) return root_in(layout.boxes[i].page, charts[i].px_of(place));
        ADD_FAILURE() << "there is no such wall";
        return 0;
    }

  private:
    double root_in(uint32_t page, glm::dvec2 px) const {
        const glm::dvec2 at = px - 0.5;
        const glm::uvec2 low(at);
        const glm::dvec2 t = at - glm::dvec2(low);
        const auto texel = [&](uint32_t x, uint32_t y) {
            return std::sqrt(double{pages[page].kd.at(low.x + x, low.y + y).g});
        };
        return glm::mix(glm::mix(texel(0, 0), texel(1, 0), t.x), glm::mix(texel(0, 1), texel(1, 1), t.x), t.y);
    }
};

/// Stripes of 2 cm across the corner and both walls.
double stripes(Place place) { return 0.6 + 0.1 * std::sin(2 * std::numbers::pi / 0.02 * (place.x + place.y)); }

/// What a wall's root differs by from the stripes.
double off(const FlatChart& chart, Place place) {
    return (chart.left ? 1 : -1) * (0.06 + 0.03 * std::sin(2 * std::numbers::pi / 0.05 * place.y));
}

double striped(const FlatChart& chart, Place place) { return stripes(place) + off(chart, place); }

/// The mean square of what changes over one texel along u around `u`; at 0 one end lies on each wall.
double gradient_energy(const Painted& painted, double u) {
    double sum = 0;
    constexpr int kSteps = 300;
    for (int i = 0; i < kSteps; ++i) {
        const double v = 0.02 + 0.16 * i / kSteps;  // 8 stripes
        const double before = u - kTexel_m / 2, after = u + kTexel_m / 2;
        const double step = painted.root_at(after < 0, {after, v}) - painted.root_at(before < 0, {before, v});
        sum += step * step / kSteps;
    }
    return sum;
}

TEST(FindSeams, TwoWallsMeetInOneLine) {
    const TextureLayout layout = corner();
    ASSERT_EQ(layout.boxes.size(), 2u);
    const std::vector<Seam> seams = find_seams(layout);
    ASSERT_EQ(seams.size(), kQuads);
    const std::vector<FlatChart> charts{{layout, layout.boxes[0]}, {layout, layout.boxes[1]}};
    for (const Seam& seam : seams) {
        ASSERT_EQ(seam.sides.size(), 2u);
        const auto place = [&](const SeamSide& side, glm::vec2 px) { return charts[side.box].at(glm::dvec2(px)); };
        const Place from = place(seam.sides[0], seam.sides[0].from_px);
        const Place to = place(seam.sides[0], seam.sides[0].to_px);
        EXPECT_NEAR(from.x, 0, 1e-6);
        EXPECT_NEAR(glm::distance(from, to), 0.01, 1e-6);
        EXPECT_LT(glm::distance(place(seam.sides[1], seam.sides[1].from_px), from), 1e-6);
        EXPECT_LT(glm::distance(place(seam.sides[1], seam.sides[1].to_px), to), 1e-6);
    }
}

TEST(LevelSeams, NoGradientIsLeftThatTheSurfaceDoesNotHave) {
    Painted painted(corner(), striped);
    EXPECT_GT(gradient_energy(painted, 0), 2 * gradient_energy(painted, 0.1)) << "before";
    painted.level();
    const double inside = gradient_energy(painted, 0.1);
    for (const double u : {-0.01, -0.004, -0.002, 0.0, 0.002, 0.004, 0.01})
        EXPECT_NEAR(gradient_energy(painted, u), inside, 0.05 * inside) << u;
    // Each wall went halfway.
    for (const double v : {0.05, 0.1, 0.15}) {
        EXPECT_NEAR(painted.root_at(true, {0, v}), stripes({0, v}), 0.01);
        EXPECT_NEAR(painted.root_at(false, {0, v}), stripes({0, v}), 0.01);
    }
}

TEST(LevelSeams, FarFromASeamNothingChanges) {
    Painted painted(corner(), striped);
    const Painted before = painted;
    painted.level();
    size_t changed = 0;
    for (size_t i = 0; i < painted.charts.size(); ++i) {
        const TextureBox& box = painted.layout.boxes[i];
        for (uint32_t y = box.low.y; y < box.high.y; ++y) {
            for (uint32_t x = box.low.x; x < box.high.x; ++x) {
                const double u = std::abs(painted.charts[i].at(glm::dvec2(x, y) + 0.5).x);
                const bool same = painted.pages[box.page].kd.at(x, y) == before.pages[box.page].kd.at(x, y);
                if (u > kSeamReach_m + 2 * kTexel_m) {
                    EXPECT_TRUE(same) << u;
                }
                changed += !same;
            }
        }
    }
    EXPECT_GT(changed, 2 * 100 * 15u);
    // It fades: near its end hardly anything is left of it, halfway about half.
    for (const double v : {0.05, 0.1, 0.15}) {
        const auto change = [&](double u) {
            return std::abs(painted.root_at(true, {u, v}) - before.root_at(true, {u, v}));
        };
        EXPECT_LT(change(-0.95 * kSeamReach_m), 0.001);
        EXPECT_GT(change(-0.5 * kSeamReach_m), 0.015);
    }
}

TEST(LevelSeams, WhatIsFilledInComesToWhatAPictureShowed) {
    Painted painted(corner(), [](const FlatChart& chart, Place) { return chart.left ? 0.8 : 0.5; });
    for (size_t i = 0; i < painted.charts.size(); ++i) {
        if (painted.charts[i].left) continue;
        const TextureBox& box = painted.layout.boxes[i];
        for (uint32_t y = box.low.y; y < box.high.y; ++y)
            for (uint32_t x = box.low.x; x < box.high.x; ++x)
                painted.pages[box.page].states.at(x, y) = TexelState::kFilled;
    }
    painted.level();
    for (const double v : {0.05, 0.1, 0.15}) {
        EXPECT_NEAR(painted.root_at(true, {0, v}), 0.8, 0.01);
        EXPECT_NEAR(painted.root_at(false, {0, v}), 0.8, 0.01);
    }
}

TEST(LevelSeams, BetweenSegmentsPaintsStayAndWhatLightErrsByGoes) {
    TextureLayout two_segments = corner();
    for (uint32_t i = 0; i < 2; ++i) two_segments.boxes[i].label = i + 1;
    for (const double step : {0.02, 0.3}) {
        Painted painted(two_segments, [&](const FlatChart& chart, Place) { return chart.left ? 0.5 : 0.5 + step; });
        painted.level();
        const double left = painted.root_at(true, {0, 0.1}), right = painted.root_at(false, {0, 0.1});
        EXPECT_NEAR(right - left, step > 0.1 ? step : 0, 0.002);
    }
}

TEST(LevelSeams, WhereTheSurfaceEndsItStaysAsItIs) {
    Painted painted(corner(true), [](const FlatChart&, Place p) { return stripes(p); });
    ASSERT_EQ(painted.layout.boxes.size(), 1u);
    const Painted before = painted;
    painted.level();
    EXPECT_EQ(painted.pages[0].kd.pixels(), before.pages[0].kd.pixels());
}

}  // namespace
}  // namespace patina::level_seams_test
