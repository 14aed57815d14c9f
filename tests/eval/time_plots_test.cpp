#include "tools/eval/time_plots.h"

#include <cmath>

#include <gmock/gmock.h>

#include "tests/eval/made_up_evaluation.h"

namespace patina::eval::time_plots_test {
namespace {

using test::full_evaluation;
using testing::ElementsAre;

std::vector<LineRole> roles_of(const Plot& plot) {
    std::vector<LineRole> roles;
    for (const PlotLine& line : plot.lines) roles.push_back(line.role);
    return roles;
}

TEST(TimePlots, ShowTruthEstimateAndRefinedPerObject) {
    const Evaluation evaluation = full_evaluation();
    const std::vector<PlotRow> rows = value_plots(evaluation);
    ASSERT_EQ(rows.size(), 4u);
    EXPECT_EQ(rows[0].title, "Diffuse albedo kd, red channel");
    ASSERT_EQ(rows[0].plots.size(), 4u);
    const Plot& plot = rows[0].plots[1];
    EXPECT_EQ(plot.title, "S2 yellow <script> figure");
    ASSERT_THAT(roles_of(plot), ElementsAre(LineRole::kTruth, LineRole::kEstimate, LineRole::kRefined));
    const auto& before = *evaluation.objects[1].quantities[Quantity::kKdBefore];
    const auto& after = *evaluation.objects[1].quantities[Quantity::kKd];
    ASSERT_EQ(plot.x.at(3), before.frames.at(3).frame);
    EXPECT_EQ(plot.lines[0].y[3], before.frames[3].truth_mean.r);
    EXPECT_EQ(plot.lines[1].y[3], before.frames[3].run_mean->r);
    EXPECT_EQ(plot.lines[2].y[3], after.frames[3].run_mean->r);
    EXPECT_THAT(roles_of(rows[1].plots[0]), ElementsAre(LineRole::kTruth, LineRole::kEstimate));
}

TEST(TimePlots, AreGapsWhereAnObjectIsNotSeen) {
    const Evaluation evaluation = full_evaluation();
    const Plot plot = value_plots(evaluation)[0].plots[0];
    const std::vector<double>& truth = plot.lines[0].y;
    const std::vector<double>& estimate = plot.lines[1].y;
    ASSERT_EQ(truth.size(), 40u);
    for (size_t i = 0; i < 40; ++i) {
        EXPECT_EQ(std::isnan(truth[i]), i >= 16 && i < 24) << i;
        EXPECT_EQ(std::isnan(estimate[i]), i == 0 || (i >= 16 && i < 24)) << i;  // nothing reconstructed in the first
    }
    EXPECT_EQ(plot.x.size(), 40u);
}

TEST(TimePlots, ErrorsAreTheMeanAbsoluteDeviationFromZeroOn) {
    const Evaluation evaluation = full_evaluation();
    const std::vector<PlotRow> rows = error_plots(evaluation);
    ASSERT_EQ(rows.size(), 4u);
    const Plot& plot = rows[3].plots[2];
    ASSERT_THAT(roles_of(plot), ElementsAre(LineRole::kEstimate, LineRole::kRefined));
    const auto& frames = evaluation.objects[2].quantities[Quantity::kRgb]->frames;
    EXPECT_EQ(plot.lines[1].y[5], frames[5].comparison.all.mad);
    for (const Plot& other : rows[3].plots) {
        EXPECT_EQ(other.y_range->low, 0);
        EXPECT_EQ(other.y_range, plot.y_range);
    }
}

TEST(TimePlots, LeaveOutWhatTheRunLacks) {
    const std::vector<PlotRow> rows = value_plots(test::geometry_only());
    ASSERT_EQ(rows.size(), 1u);
    EXPECT_EQ(rows[0].title, "Re-rendered RGB, red channel");
    EXPECT_THAT(roles_of(rows[0].plots[0]), ElementsAre(LineRole::kTruth, LineRole::kRefined));
    EXPECT_TRUE(value_plots({}).empty());
}

TEST(TimePlots, PerfectRunsHaveAnAxis) {
    Evaluation evaluation = full_evaluation(1, 2);
    for (FramePoint& point : evaluation.objects[0].quantities[Quantity::kKs]->frames) {
        point.comparison.filled = Scores{};
    }
    EXPECT_EQ(error_plots(evaluation)[1].plots[0].y_range, (PlotRange{0, 0.1}));
}

}  // namespace
}  // namespace patina::eval::time_plots_test
