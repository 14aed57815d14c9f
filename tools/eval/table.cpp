#include "tools/eval/table.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include <fmt/format.h>

#include "engine/core/error.h"

namespace patina::eval {
namespace {

constexpr const char* kNothing = "-";

std::string number(double value, int decimals) {
    return std::isinf(value) ? "inf" : fmt::format("{:.{}f}", value, decimals);
}

std::string percent(double share) { return fmt::format("{:.1f}%", 100 * share); }

struct Metric {
    const char* title;
    std::function<std::string(const Scores&)> text;
};

const std::vector<Metric>& metrics() {
    static const std::vector<Metric> kMetrics = {
        {"MAD", [](const Scores& scores) { return number(scores.mad, 4); }},
        {"RMSE", [](const Scores& scores) { return number(scores.rmse, 4); }},
        {"PSNR, dB", [](const Scores& scores) { return number(scores.psnr_db, 2); }},
        {"SSIM", [](const Scores& scores) { return number(scores.ssim, 4); }}};
    return kMetrics;
}

using CellText = std::function<std::string(const Comparison&)>;

CellText score_text(const Metric& metric, Pixels pixels) {
    if (pixels == Pixels::kUnfilledAsZero) {
        return [&metric](const Comparison& comparison) { return metric.text(comparison.unfilled_as_zero); };
    }
    return [&metric](const Comparison& comparison) {
        return comparison.filled ? metric.text(*comparison.filled) : kNothing;
    };
}

/// One row per object and one for their average, one column per quantity.
std::vector<std::vector<std::string>> cells_by_object(const Evaluation& evaluation, const CellText& text) {
    std::vector<std::vector<std::string>> rows;
    for (const ObjectResult& object : evaluation.objects) {
        auto& row = rows.emplace_back();
        for (const Quantity quantity : kQuantities) {
            const auto& measured = object.quantities[quantity];
            row.push_back(measured ? text(measured->mean) : kNothing);
        }
    }
    auto& average = rows.emplace_back();
    for (const Quantity quantity : kQuantities) {
        const auto& measured = evaluation.object_means[quantity];
        average.push_back(measured ? text(*measured) : kNothing);
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

std::string scored_pixels(const Evaluation& evaluation) {
    if (evaluation.seen_frames <= 1) return "Scores over every pixel that has truth.";
    return fmt::format("Scores over pixels whose surface was seen in at least {} frames, {} of those that have truth.",
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
    for (const Quantity quantity : kQuantities) table.rows.push_back(title_of(quantity));
    if (table.is_turned) table.rows.swap(table.columns);
    const auto add = [&](const char* metric, const CellText& text) {
        const auto cells = cells_by_object(evaluation, text);
        table.metrics.push_back({metric, table.is_turned ? cells : turned(cells)});
    };
    for (const Metric& metric : metrics()) add(metric.title, score_text(metric, pixels));
    if (pixels == Pixels::kFilled)
        add("coverage", [](const Comparison& comparison) { return percent(comparison.coverage); });
    return table;
}

bool has_unfilled(const Evaluation& evaluation) {
    for (const ObjectResult& object : evaluation.objects) {
        for (const Quantity quantity : kQuantities) {
            const auto& measured = object.quantities[quantity];
            if (measured && measured->mean.coverage < 1) return true;
        }
    }
    return false;
}

/// Of the run's, where the trajectories were compared.
size_t poses_without_truth(const Evaluation& evaluation) {
    return evaluation.trajectory ? evaluation.trajectory->run_poses - evaluation.trajectory->poses : 0;
}

std::vector<std::string> absences(const Evaluation& evaluation) {
    if (evaluation.objects.empty()) return {"No object of the truth is seen in the evaluated frames."};
    std::vector<std::string> missing, list;
    for (const Quantity quantity : kQuantities) {
        if (!evaluation.object_means[quantity]) missing.push_back(title_of(quantity));
    }
    if (evaluation.seen_share == 0) {
        list.push_back(
            fmt::format("No surface was seen in at least {} frames by the evaluated ones; --seen 1 scores "
                        "every pixel that has truth.",
                        evaluation.seen_frames));
    } else if (!missing.empty()) {
        list.push_back("The run's frames hold no " + listed(missing) + ".");
    }
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
