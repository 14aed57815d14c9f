#include "tools/eval/table.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include <fmt/format.h>

#include "engine/core/error.h"

namespace patina::eval {
namespace {

constexpr const char* kNothing = "-";
constexpr double kShownProbability = 0.9;  // of intervals

std::string number(double value, int decimals) {
    return std::isinf(value) ? "inf" : fmt::format("{:.{}f}", value, decimals);
}

std::string percent(double share) { return fmt::format("{:.1f}%", 100 * share); }

struct Metric {
    const char* title;
    const char* short_title;  ///< of a column
    std::function<std::string(const Scores&)> text;
};

const std::vector<Metric>& metrics() {
    static const std::vector<Metric> kMetrics = {
        {"MAD", "MAD", [](const Scores& scores) { return number(scores.mad, 4); }},
        {"RMSE", "RMSE", [](const Scores& scores) { return number(scores.rmse, 4); }},
        {"PSNR, dB", "PSNR", [](const Scores& scores) { return number(scores.psnr_db, 2); }},
        {"SSIM", "SSIM", [](const Scores& scores) { return number(scores.ssim, 4); }},
        {"PSNR of sRGB, dB", "sRGB",
         [](const Scores& scores) { return scores.psnr_srgb_db ? number(*scores.psnr_srgb_db, 2) : kNothing; }}};
    return kMetrics;
}

std::string score_text(const Metric& metric, const Comparison& comparison, Pixels pixels) {
    const Scores* scores = comparison.over(pixels);
    return scores ? metric.text(*scores) : kNothing;
}

using Means = PerQuantity<std::optional<Averages>>;

/// Those of Table 1, and of what is shown those that some object has.
std::vector<Quantity> quantities_in(const Means& means) {
    std::vector<Quantity> quantities;
    for (const Quantity quantity : kQuantities) {
        const bool is_shown = quantity == Quantity::kKdShown || quantity == Quantity::kRgbShown;
        if (!is_shown || means[quantity]) quantities.push_back(quantity);
    }
    return quantities;
}

using CellText = std::function<std::string(const Comparison&)>;

/// One row per object and one for their average, one column per quantity.
std::vector<std::vector<std::string>> cells_by_object(const Evaluation& evaluation, const CellText& text) {
    const std::vector<Quantity> quantities = quantities_in(evaluation.object_means);
    std::vector<std::vector<std::string>> rows;
    for (const ObjectResult& object : evaluation.objects) {
        auto& row = rows.emplace_back();
        for (const Quantity quantity : quantities) {
            const auto& measured = object.quantities[quantity];
            row.push_back(measured ? text(measured->mean) : kNothing);
        }
    }
    auto& average = rows.emplace_back();
    for (const Quantity quantity : quantities) {
        const auto& measured = evaluation.object_means[quantity];
        average.push_back(measured ? text(measured->mean) : kNothing);
    }
    return rows;
}

/// One row per quantity, one column per score.
std::vector<std::vector<std::string>> summary_cells(const Means& means, Pixels pixels, Period period) {
    std::vector<std::vector<std::string>> rows;
    for (const Quantity quantity : quantities_in(means)) {
        const auto& measured = means[quantity];
        auto& row = rows.emplace_back();
        for (const Metric& metric : metrics())
            row.push_back(measured ? score_text(metric, measured->over(period), pixels) : kNothing);
    }
    return rows;
}

std::vector<std::vector<std::string>> turned(const std::vector<std::vector<std::string>>& cells) {
    std::vector<std::vector<std::string>> result(cells.front().size());
    for (const auto& row : cells) {
        for (size_t i = 0; i < row.size(); ++i) result[i].push_back(row[i]);
    }
    return result;
}

std::string listed(const std::vector<std::string>& words) {
    std::string text;
    for (size_t i = 0; i < words.size(); ++i) text += (i == 0 ? "" : i + 1 < words.size() ? ", " : " and ") + words[i];
    return text;
}

void add_pixel_errors(std::vector<Finding>& list, const char* name, const std::optional<PixelErrors>& errors,
                      const char* unit) {
    if (!errors) return;
    list.push_back(
        {name, fmt::format("{:.2f} {} median, {:.2f} mean, {:.2f} at 90% of the pixels, RMSE {:.2f}; coverage {}",
                           errors->median, unit, errors->mean, errors->p90, errors->rmse, percent(errors->coverage))});
}

void add_relative(std::vector<Finding>& list, const char* name, const std::optional<RelativePoseError>& error) {
    if (!error) return;
    list.push_back(
        {name,
         fmt::format("RMSE {:.2f} mm, {:.3f} deg; median {:.2f} mm, {:.3f} deg; at most {:.2f} mm, {:.3f} deg; {} x "
                     "{:.3f} s",
                     1e3 * error->translation_rmse_m, error->rotation_rmse_deg, 1e3 * error->translation_median_m,
                     error->rotation_median_deg, 1e3 * error->translation_max_m, error->rotation_max_deg, error->pairs,
                     error->step_s)});
}

/// "kd 33 of 36, width 0.021".
std::string hits_text(const char* name, const IntervalHits& hits) {
    if (hits.values == 0) return fmt::format("{} -", name);
    return fmt::format("{} {} of {}, width {:.3f}", name, hits.within, hits.values, hits.mean_width());
}

void add_intervals(std::vector<Finding>& list, const std::vector<IntervalCounts>& intervals) {
    for (const IntervalCounts& counts : intervals) {
        if (counts.probability != kShownProbability) continue;
        list.push_back({"Intervals",
                        fmt::format("of {:.0f}% hold {}; {}; {}", 100 * counts.probability, hits_text("kd", counts.kd),
                                    hits_text("ks", counts.ks), hits_text("alpha", counts.alpha))});
    }
}

std::string three(glm::dvec3 v, int decimals) {
    return fmt::format("{:.{}f}, {:.{}f}, {:.{}f}", v.x, decimals, v.y, decimals, v.z, decimals);
}

std::string three_percent(glm::dvec3 v) { return fmt::format("{} {} {}", percent(v.r), percent(v.g), percent(v.b)); }

}  // namespace

std::string short_name(size_t object) { return fmt::format("S{}", object + 1); }

std::string column_key(const Evaluation& evaluation) {
    std::string text;
    if (evaluation.objects.size() > kMostObjectColumns) return text;
    for (size_t i = 0; i < evaluation.objects.size(); ++i) {
        text += (i == 0 ? "" : ", ") + short_name(i) + ' ' + evaluation.objects[i].name;
    }
    return text;
}

std::string scored_pixels(const Evaluation& evaluation, Pixels pixels) {
    switch (pixels) {
        case Pixels::kAll: return "Scores over all pixels that have truth; where the run has no value it counts as 0.";
        case Pixels::kFilled: return "Scores over the pixels that the run filled.";
        case Pixels::kSeen: break;
    }
    if (evaluation.seen_frames <= 1) return "Every pixel counts as seen: scores as over those that the run filled.";
    return fmt::format(
        "Scores over filled pixels whose surface was seen in at least {} frames, {} of those that have "
        "truth.",
        evaluation.seen_frames, percent(evaluation.seen_share));
}

const char* title_of(Quantity quantity) {
    switch (quantity) {
        case Quantity::kKdBefore: return "kd";
        case Quantity::kKd: return "kd refined";
        case Quantity::kKs: return "ks";
        case Quantity::kAlpha: return "alpha";
        case Quantity::kRgbBefore: return "RGB";
        case Quantity::kRgb: return "RGB refined";
        case Quantity::kKdShown: return "kd shown";
        case Quantity::kRgbShown: return "RGB shown";
    }
    PATINA_ASSERT(false, "quantity ", static_cast<int>(quantity));
}

ScoreTable score_table(const Evaluation& evaluation, Pixels pixels) {
    ScoreTable table;
    table.is_turned = evaluation.objects.size() > kMostObjectColumns;
    for (size_t i = 0; i < evaluation.objects.size(); ++i) {
        table.columns.push_back(table.is_turned ? short_name(i) + " " + evaluation.objects[i].name : short_name(i));
    }
    table.columns.push_back("avg");
    for (const Quantity quantity : quantities_in(evaluation.object_means)) table.rows.push_back(title_of(quantity));
    if (table.is_turned) table.rows.swap(table.columns);
    const auto add = [&](const char* metric, const CellText& text) {
        const auto cells = cells_by_object(evaluation, text);
        table.metrics.push_back({metric, table.is_turned ? cells : turned(cells)});
    };
    for (const Metric& metric : metrics()) {
        add(metric.title, [&](const Comparison& comparison) { return score_text(metric, comparison, pixels); });
    }
    if (pixels == Pixels::kAll)
        add("coverage", [](const Comparison& comparison) { return percent(comparison.coverage); });
    return table;
}

namespace {

ScoreTable empty_summary(const Means& means) {
    ScoreTable table;
    for (const Quantity quantity : quantities_in(means)) table.rows.push_back(title_of(quantity));
    for (const Metric& metric : metrics()) table.columns.push_back(metric.short_title);
    return table;
}

std::string title_of(Pixels pixels, uint32_t seen_frames) {
    switch (pixels) {
        case Pixels::kAll: return "all pixels";
        case Pixels::kFilled: return "filled pixels";
        case Pixels::kSeen: return fmt::format("seen in {} frames", seen_frames);
    }
    PATINA_ASSERT(false, "pixels ", static_cast<int>(pixels));
}

}  // namespace

ScoreTable summary_table(const Evaluation& evaluation) {
    ScoreTable table = empty_summary(evaluation.object_means);
    for (const Period period : {Period::kAllFrames, Period::kLastFrames}) {
        for (const Pixels pixels : kPixels) {
            table.metrics.push_back(
                {title_of(pixels, evaluation.seen_frames) + (period == Period::kLastFrames ? ", last tenth" : ""),
                 summary_cells(evaluation.object_means, pixels, period)});
        }
    }
    return table;
}

ScoreTable summary_table(const Views& views) {
    ScoreTable table = empty_summary(views.object_means);
    for (const Pixels pixels : {Pixels::kAll, Pixels::kFilled})
        table.metrics.push_back({title_of(pixels, 0), summary_cells(views.object_means, pixels, Period::kAllFrames)});
    return table;
}

std::vector<ViewsSection> views_sections(const Evaluation& evaluation) {
    std::vector<ViewsSection> sections;
    const auto add = [&](const std::optional<Views>& views, const char* title) {
        if (views) sections.push_back({fmt::format("{}, {} views", title, views->frames.size()), *views});
    };
    add(evaluation.finished, "The finished model");
    add(evaluation.novel, "Never recorded: from off the path");
    add(evaluation.relit, "Never recorded: the same under other lamps");
    return sections;
}

/// Of the run's, where the trajectories were compared.
size_t poses_without_truth(const Evaluation& evaluation) {
    return evaluation.trajectory ? evaluation.trajectory->run_poses - evaluation.trajectory->poses : 0;
}

std::vector<std::string> absences(const Evaluation& evaluation) {
    if (evaluation.objects.empty()) return {"No object of the truth is seen in the evaluated frames."};
    std::vector<std::string> missing, list;
    for (const Quantity quantity : quantities_in(evaluation.object_means)) {
        if (!evaluation.object_means[quantity]) missing.push_back(title_of(quantity));
    }
    if (!missing.empty()) list.push_back("The run's frames hold no " + listed(missing) + ".");
    if (evaluation.seen_share == 0)
        list.push_back(
            fmt::format("No surface was seen in at least {} frames by the evaluated ones.", evaluation.seen_frames));
    const auto note = [&](bool present, const char* sentence) {
        if (!present) list.push_back(sentence);
    };
    note(evaluation.depth_mm.has_value(), "Depth was not compared: truth and run do not both have it.");
    note(evaluation.normal_deg.has_value(), "Normals were not compared: truth and run do not both have them.");
    note(evaluation.segmentation.has_value(), "Segmentation was not measured: the run's frames hold no labels.");
    if (!evaluation.trajectory) list.push_back("The trajectory was not compared: " + evaluation.no_trajectory + ".");
    if (const size_t unknown = poses_without_truth(evaluation); unknown > 0) {
        list.push_back(fmt::format("{} of the run's {} poses are at times for which truth has none.", unknown,
                                   evaluation.trajectory->run_poses));
    }
    if (!evaluation.no_views.empty()) list.push_back(evaluation.no_views);
    note(evaluation.lights.has_value(), "Lights were not compared: truth and run do not both have a lights.json.");
    return list;
}

std::vector<Finding> findings(const Evaluation& evaluation) {
    std::vector<Finding> list;
    add_pixel_errors(list, "Depth error", evaluation.depth_mm, "mm");
    add_pixel_errors(list, "Normal error", evaluation.normal_deg, "deg");
    if (const auto& trajectory = evaluation.trajectory) {
        list.push_back(
            {"Trajectory",
             fmt::format("ATE RMSE {:.2f} mm, at most {:.2f} mm; {:.2f} mm without alignment; {} of {} poses",
                         1e3 * trajectory->ate_rmse_m, 1e3 * trajectory->ate_max_m, 1e3 * trajectory->unaligned_rmse_m,
                         trajectory->poses, trajectory->truth_poses)});
        add_relative(list, "RPE per frame", trajectory->per_frame);
        add_relative(list, "RPE per second", trajectory->per_second);
    }
    if (const auto& states = evaluation.states) {
        list.push_back({"Frames", fmt::format("{} tracking, {} weak, {} lost; only those that track were fused",
                                              states->tracking, states->weak, states->lost)});
    }
    if (const auto& segmentation = evaluation.segmentation) {
        list.push_back(
            {"Segmentation",
             fmt::format(
                 "best-overlap IoU {:.3f}; best label on {} of an object, {} of it elsewhere; {:.1f} labels an object",
                 segmentation->iou, percent(segmentation->best_label_share), percent(segmentation->foreign_share),
                 segmentation->labels)});
    }
    add_intervals(list, evaluation.intervals);
    if (const auto& lights = evaluation.lights) {
        list.push_back({"Lights", fmt::format("{} of {} matched within {:.2f} m; {} missed, {} invented; the run's "
                                              "intensities are {:.3f} times the true ones",
                                              lights->matches.size(), lights->truth.size(), lights->radius_m,
                                              lights->missed.size(), lights->invented.size(), lights->common_factor)});
    }
    return list;
}

std::vector<LightRow> light_rows(const LightErrors& lights) {
    std::vector<LightRow> rows;
    for (size_t i = 0; i < lights.truth.size(); ++i) {
        LightRow row{fmt::format("true light {}", i + 1), three(lights.truth[i].position_m, 2), "missed", {}, {}, {}};
        const auto match = std::ranges::find(lights.matches, i, &LightMatch::truth);
        if (match != lights.matches.end()) {
            row.match = fmt::format("light {} of the run", match->run + 1);
            row.position_error = fmt::format("{:.1f} mm", 1e3 * match->position_error_m);
            row.intensity_error = three_percent(match->intensity_error);
            row.after_factor = three_percent(match->intensity_error_after_factor);
        }
        rows.push_back(std::move(row));
    }
    for (const size_t i : lights.invented) {
        rows.push_back(
            {fmt::format("light {} of the run", i + 1), three(lights.run[i].position_m, 2), "invented", {}, {}, {}});
    }
    return rows;
}

}  // namespace patina::eval
