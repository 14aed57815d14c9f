#include "tools/report/plot.h"

#include <limits>

#include <gmock/gmock.h>

#include "tests/export/throws.h"

namespace patina::plot_test {
namespace {

using testing::ContainsRegex;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

constexpr double kGap = std::numeric_limits<double>::quiet_NaN();

Plot plot_of(std::vector<double> y) {
    Plot plot{.title = "floor",
              .y_label = "kd, red",
              .x = {},
              .lines = {{"estimate", LineRole::kEstimate, y}},
              .y_range = {}};
    for (size_t i = 0; i < y.size(); ++i) plot.x.push_back(static_cast<double>(i));
    return plot;
}

/// What stands in the d attribute of the path of this class.
std::string path_of(const std::string& svg, const std::string& css_class) {
    const std::string start = "<path class='" + css_class + "' d='";
    const size_t at = svg.find(start);
    if (at == std::string::npos) return {};
    return svg.substr(at + start.size(), svg.find('\'', at + start.size()) - at - start.size());
}

size_t count_of(const std::string& text, char letter) {
    return static_cast<size_t>(std::count(text.begin(), text.end(), letter));
}

std::vector<std::string> labels_of(const Ticks& ticks) {
    std::vector<std::string> labels;
    for (int i = 0; i < ticks.count; ++i) labels.push_back(ticks.label(i));
    return labels;
}

TEST(Ticks, AreRoundAndCoverTheRange) {
    EXPECT_THAT(labels_of(nice_ticks({0, 1}, 5)), ElementsAre("0.0", "0.2", "0.4", "0.6", "0.8", "1.0"));
    EXPECT_THAT(labels_of(nice_ticks({0, 999}, 5)), ElementsAre("0", "200", "400", "600", "800", "1000"));
    EXPECT_THAT(labels_of(nice_ticks({0.013, 0.047}, 4)), ElementsAre("0.01", "0.02", "0.03", "0.04", "0.05"));
    EXPECT_THAT(labels_of(nice_ticks({-0.3, 0.3}, 4)), ElementsAre("-0.4", "-0.2", "0.0", "0.2", "0.4"));
    EXPECT_THAT(labels_of(nice_ticks({17, 23}, 4)), ElementsAre("16", "18", "20", "22", "24"));
}

TEST(Ticks, RoundingAddsNone) {
    EXPECT_THAT(labels_of(nice_ticks({0.1, 0.1 + 0.2}, 4)), ElementsAre("0.10", "0.15", "0.20", "0.25", "0.30"));
    EXPECT_THAT(labels_of(nice_ticks({0, 0.6}, 3)), ElementsAre("0.0", "0.2", "0.4", "0.6"));
}

TEST(Ticks, ValueAloneLiesInTheMiddle) {
    EXPECT_EQ(nice_ticks({0.5, 0.5}, 4).range(), (PlotRange{0.2, 0.8}));
    EXPECT_EQ(nice_ticks({0, 0}, 4).range(), (PlotRange{-0.5, 0.5}));
}

TEST(Ticks, FramesAreWhole) {
    EXPECT_THAT(labels_of(nice_ticks({0, 1}, 5, 1)), ElementsAre("0", "1"));
    EXPECT_THAT(labels_of(nice_ticks({3, 3}, 5, 1)), ElementsAre("1", "2", "3", "4", "5"));
}

TEST(Ticks, LongNumbersAreShortened) {
    EXPECT_THAT(labels_of(nice_ticks({0, 2e-7}, 2)), ElementsAre("0", "1e-07", "2e-07"));
    EXPECT_THAT(labels_of(nice_ticks({0, 3e9}, 3)), ElementsAre("0", "1e+09", "2e+09", "3e+09"));
}

TEST(Plot, FollowsTheValues) {
    // 230 units wide from 42, 104 high down to 128; the ticks go from 0 to 1.
    EXPECT_EQ(path_of(plot_svg(plot_of({0, 0.5, 1})), "estimate"), "M42.0 128.0L157.0 76.0L272.0 24.0");
}

TEST(Plot, GapsBreakThePath) {
    const std::string path = path_of(plot_svg(plot_of({0, 0.5, kGap, 0.5, 1, kGap})), "estimate");
    EXPECT_EQ(count_of(path, 'M'), 2u);
    EXPECT_EQ(count_of(path, 'L'), 2u);
}

TEST(Plot, PointBetweenGapsIsADot) {
    EXPECT_EQ(path_of(plot_svg(plot_of({0, kGap, 1, kGap, 0})), "estimate"),
              "M42.0 128.0h0M157.0 24.0h0M272.0 128.0h0");
}

TEST(Plot, ShowsNothingThatIsNoNumber) {
    const double infinity = std::numeric_limits<double>::infinity();
    for (const auto& values : std::vector<std::vector<double>>{
             {}, {kGap}, {kGap, infinity}, {1, kGap, -infinity}, {0}, {1e300, -1e300}, {1e-300, 0}}) {
        const std::string svg = plot_svg(plot_of(values));
        EXPECT_THAT(svg, Not(ContainsRegex("[^a-z](nan|inf)[^a-z]"))) << svg;
    }
}

TEST(Plot, SaysWhenThereIsNothing) {
    for (const auto& values : std::vector<std::vector<double>>{{}, {kGap, kGap}}) {
        const std::string svg = plot_svg(plot_of(values));
        EXPECT_THAT(svg, HasSubstr(">no values</text>"));
        EXPECT_THAT(svg, Not(HasSubstr("<path")));
        EXPECT_THAT(svg, HasSubstr("estimate without values"));
    }
    EXPECT_THAT(plot_svg({}), HasSubstr("no values"));
}

TEST(Plot, TellsInWordsWhatItShows) {
    Plot plot = plot_of({0.25, kGap, 0.75});
    plot.lines.insert(plot.lines.begin(), {"true value", LineRole::kTruth, {0.5, kGap, 0.5}});
    EXPECT_THAT(plot_svg(plot),
                HasSubstr("<desc>kd, red over frames: true value 0.5; estimate 0.25 to 0.75, mean 0.5.</desc>"));
}

TEST(Plot, EscapesNames) {
    Plot plot = plot_of({0, 1});
    plot.title = plot.y_label = plot.lines[0].name = "<script>&'\"";
    const std::string html = plot_grid({&plot, 1});
    EXPECT_THAT(html, Not(HasSubstr("<script>")));
    EXPECT_THAT(html, HasSubstr("<title>&lt;script&gt;&amp;&#39;&quot;</title>"));
}

TEST(Plot, CoversTheRangeItIsToldTo) {
    Plot plot = plot_of({0.5, 0.5});
    plot.y_range = PlotRange{0, 1};
    EXPECT_EQ(path_of(plot_svg(plot), "estimate"), "M42.0 76.0L272.0 76.0");
}

TEST(Plot, ManyPointsAreThinnedToTheirExtremes) {
    std::vector<double> values(10000, 0.5);
    values[5001] = 1;
    values[5002] = 0;
    const std::string path = path_of(plot_svg(plot_of(values)), "estimate");
    EXPECT_LT(count_of(path, 'L'), 250u);
    EXPECT_THAT(path, HasSubstr(" 24.0L157"));   // the highest
    EXPECT_THAT(path, HasSubstr(" 128.0L158"));  // then the lowest
}

TEST(Plot, LinesMustFitTheFrames) {
    Plot plot = plot_of({0, 1});
    plot.x.push_back(2);
    EXPECT_THAT([&] { plot_svg(plot); }, test::throws_error_with("'estimate' has 2 values for 3 frames"));
}

TEST(Plot, RangeOfSeveralLeavesOutGaps) {
    const std::vector<Plot> plots{plot_of({0.25, kGap}), plot_of({-1, 0.5})};
    EXPECT_EQ(range_of(plots), (PlotRange{-1, 0.5}));
    EXPECT_EQ(range_of({}), std::nullopt);
}

TEST(Plot, LegendHasTheRolesThatOccur) {
    const std::vector<Plot> plots{plot_of({0.25, kGap}), plot_of({-1, 0.5})};
    EXPECT_THAT(plot_grid(plots), AllOf(HasSubstr("</svg>estimate</span>"), Not(HasSubstr("path class='truth'"))));
    EXPECT_EQ(plot_grid({}), "");
}

}  // namespace
}  // namespace patina::plot_test
