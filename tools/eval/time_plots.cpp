#include "tools/eval/time_plots.h"

#include <algorithm>
#include <functional>
#include <limits>

#include "tools/eval/table.h"

namespace patina::eval {
namespace {

/// What a row of plots shows: a quantity, and what it became by refinement.
struct PlotKind {
    const char* title;
    const char* channel;  ///< which one stands for all
    const char* symbol;
    Quantity estimate;
    std::optional<Quantity> refined;
};

const std::array kRowKinds = {
    PlotKind{"Diffuse albedo kd", ", red channel", "kd", Quantity::kKdBefore, Quantity::kKd},
    PlotKind{"Specular albedo ks", ", red channel", "ks", Quantity::kKs, {}},
    PlotKind{"Roughness alpha", "", "alpha", Quantity::kAlpha, {}},
    PlotKind{"Re-rendered RGB", ", red channel", "RGB", Quantity::kRgbBefore, Quantity::kRgb}};

using ValueOf = std::function<std::optional<double>(const FramePoint&)>;

std::optional<double> truth_red(const FramePoint& point) { return point.truth_mean.r; }
std::optional<double> run_red(const FramePoint& point) {
    return point.run_mean ? std::optional(point.run_mean->r) : std::nullopt;
}
std::optional<double> deviation(const FramePoint& point) { return point.comparison.all.mad; }

/// A value per evaluated frame, gaps where there is none.
std::vector<double> over_frames(const Evaluation& evaluation, const ObjectQuantity& quantity, const ValueOf& value_of) {
    std::vector<double> values(evaluation.frames.size(), std::numeric_limits<double>::quiet_NaN());
    for (const FramePoint& point : quantity.frames) {
        const auto at = std::ranges::lower_bound(evaluation.frames, point.frame);
        if (at == evaluation.frames.end() || *at != point.frame) continue;
        if (const auto value = value_of(point)) values[static_cast<size_t>(at - evaluation.frames.begin())] = *value;
    }
    return values;
}

Plot empty_plot(const Evaluation& evaluation, size_t object) {
    Plot plot;
    plot.title = short_name(object) + ' ' + evaluation.objects[object].name;
    plot.x.assign(evaluation.frames.begin(), evaluation.frames.end());
    plot.hue = object;
    return plot;
}

/// Lines of the estimate and of what it was refined into, as far as the object has them.
void add_lines(Plot& plot, const Evaluation& evaluation, const ObjectResult& object, const PlotKind& kind,
               const ValueOf& value_of) {
    if (const auto& estimate = object.quantities[kind.estimate]) {
        plot.lines.push_back({"reconstruction", LineRole::kEstimate, over_frames(evaluation, *estimate, value_of)});
    }
    if (!kind.refined) return;
    if (const auto& refined = object.quantities[*kind.refined]) {
        plot.lines.push_back({"refined", LineRole::kRefined, over_frames(evaluation, *refined, value_of)});
    }
}

void add_truth(Plot& plot, const Evaluation& evaluation, const ObjectResult& object, const PlotKind& kind) {
    const auto& estimate = object.quantities[kind.estimate];
    const auto& measured = estimate || !kind.refined ? estimate : object.quantities[*kind.refined];
    if (!measured) return;
    plot.lines.push_back({"true value", LineRole::kTruth, over_frames(evaluation, *measured, truth_red)});
}

/// One plot per object with the lines that `fill` adds; empty where no object has any.
std::vector<Plot> plots_of(const Evaluation& evaluation, const std::function<void(Plot&, const ObjectResult&)>& fill) {
    std::vector<Plot> plots;
    for (size_t i = 0; i < evaluation.objects.size(); ++i) {
        fill(plots.emplace_back(empty_plot(evaluation, i)), evaluation.objects[i]);
    }
    if (std::ranges::all_of(plots, [](const Plot& plot) { return plot.lines.empty(); })) plots.clear();
    return plots;
}

}  // namespace

std::vector<PlotRow> value_plots(const Evaluation& evaluation) {
    std::vector<PlotRow> rows;
    for (const PlotKind& kind : kRowKinds) {
        PlotRow row{std::string(kind.title) + kind.channel, plots_of(evaluation, [&](Plot& plot, const auto& object) {
                        plot.y_label = std::string(kind.symbol) + kind.channel;
                        add_truth(plot, evaluation, object, kind);
                        add_lines(plot, evaluation, object, kind, run_red);
                    })};
        const auto range = range_of(row.plots);
        for (Plot& plot : row.plots) plot.y_range = range;
        if (!row.plots.empty()) rows.push_back(std::move(row));
    }
    return rows;
}

std::vector<PlotRow> error_plots(const Evaluation& evaluation) {
    std::vector<PlotRow> rows;
    for (const PlotKind& kind : kRowKinds) {
        PlotRow row{kind.title, plots_of(evaluation, [&](Plot& plot, const auto& object) {
                        plot.y_label = std::string("Mean absolute deviation of ") + kind.symbol;
                        add_lines(plot, evaluation, object, kind, deviation);
                    })};
        const auto range = range_of(row.plots);
        // From 0 on; a perfect reconstruction needs some height too.
        const double high = range && range->high > 0 ? range->high : 0.1;
        for (Plot& plot : row.plots) plot.y_range = PlotRange{0, high};
        if (!row.plots.empty()) rows.push_back(std::move(row));
    }
    return rows;
}

}  // namespace patina::eval
