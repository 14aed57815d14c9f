#include "tools/eval/eval_report.h"

#include <fmt/format.h>

#include "export/html.h"
#include "tools/eval/table.h"
#include "tools/eval/time_plots.h"
#include "tools/report/report_page.h"

namespace patina::eval {
namespace {

constexpr std::string_view kStyle = R"css(
h3 { font-size: 1rem; margin: 1.4rem 0 .3rem; break-after: avoid; }
p { margin: .3rem 0 .8rem; max-width: 60rem; }
.scores { --label: 6.5rem; display: grid; grid-template-columns: repeat(auto-fill, minmax(calc(var(--label) + var(--columns) * 3.6rem), 1fr)); gap: 0 2.5rem; }
.scores.turned { --label: 10.5rem; }
.scores > div { break-inside: avoid; min-width: 0; }
.scores th, .scores td { padding-right: 0; padding-left: .5rem; font-size: .85rem; }
.scores.turned th, .scores.turned td { padding-left: .35rem; font-size: .8rem; }
.scores th:first-child, .scores.turned th:first-child { padding-left: 0; max-width: var(--label); overflow: hidden; text-overflow: ellipsis; white-space: nowrap; }
.scores:not(.turned) td:last-child, .scores.turned tr:last-child td { font-weight: 600; }
th.number { white-space: normal; vertical-align: bottom; }
td.name { white-space: nowrap; }
.errors { display: grid; grid-template-columns: repeat(3, minmax(0, 1fr)); gap: .5rem; }
.errors figure { margin: 0; }
.errors figure img { image-rendering: auto; border-radius: 0; }
.errors figcaption { display: flex; flex-wrap: wrap; gap: 0 .4rem; align-items: center; white-space: nowrap; }
.errors figcaption img, .sample { display: inline-block; width: 5rem; height: .7rem; }
.sample { width: 2rem; height: 1rem; vertical-align: -.15rem; }
.meaning { white-space: nowrap; margin-left: .6rem; }
@media print { .errors { gap: .3rem; } .errors figure { break-inside: avoid; } .scroll { overflow: visible; } }
@media (max-width: 40rem) { .scores { grid-template-columns: 1fr; } }
)css";

std::string paragraph(std::string_view text) { return fmt::format("<p>{}</p>\n", html_escaped(text)); }

std::string sub_heading(std::string_view text) { return fmt::format("<h3>{}</h3>\n", html_escaped(text)); }

std::string embedded(std::string_view png, std::string_view alt, std::string_view attributes = {}) {
    return fmt::format("<img{} alt=\"{}\" src=\"data:image/png;base64,{}\">", attributes, html_escaped(alt),
                       base64(png));
}

/// A <th> or <td> per text, set as numbers are.
std::string cells(const char* tag, const std::vector<std::string>& texts) {
    std::string html;
    for (const std::string& text : texts) html += fmt::format("<{0} class='number'>{1}</{0}>", tag, html_escaped(text));
    return html;
}

std::string facts(const Evaluation& evaluation) {
    std::string html = report_fact("Frames compared", grouped(evaluation.frames.size()));
    html += report_fact("Frames of truth / of the run",
                        grouped(evaluation.truth_frames) + " / " + grouped(evaluation.run_frames));
    html += report_fact("Objects", grouped(evaluation.objects.size()));
    html += report_fact("Pixels", fmt::format("{} &times; {}", evaluation.extent.width, evaluation.extent.height));
    return report_facts(html);
}

std::string metric_table(const ScoreTable& table, const MetricCells& metric) {
    std::string rows;
    for (size_t row = 0; row < table.rows.size(); ++row) {
        rows += fmt::format("<tr><th>{}</th>{}</tr>\n", html_escaped(table.rows[row]), cells("td", metric.cells[row]));
    }
    return fmt::format("<div>{}{}</div>\n", sub_heading(metric.metric),
                       report_table("<th></th>" + cells("th", table.columns), rows));
}

std::string metric_tables(const ScoreTable& table) {
    std::string html;
    for (const MetricCells& metric : table.metrics) html += metric_table(table, metric);
    return fmt::format("<div class='scores{}' style='--columns: {}'>\n{}</div>\n", table.is_turned ? " turned" : "",
                       table.columns.size(), html);
}

std::string averages(const Evaluation& evaluation) {
    if (evaluation.objects.empty()) return {};
    return paragraph(
               "Over the objects. RGB before and after refinement, and kd, are the model's own: without detail "
               "restored "
               "from the fused colour. What a user is shown has it.") +
           metric_tables(summary_table(evaluation));
}

std::string scores(const Evaluation& evaluation, Pixels pixels) {
    if (evaluation.objects.empty()) return {};
    const std::string key = column_key(evaluation);
    return paragraph(scored_pixels(evaluation, pixels)) + (key.empty() ? key : paragraph(key)) +
           metric_tables(score_table(evaluation, pixels));
}

std::string finding_table(const Evaluation& evaluation) {
    std::string rows;
    for (const Finding& finding : findings(evaluation)) {
        rows +=
            fmt::format("<tr><td>{}</td><td>{}</td></tr>\n", html_escaped(finding.name), html_escaped(finding.value));
    }
    return rows.empty() ? rows : report_table("<th>What</th><th>Result</th>", rows);
}

std::string light_table(const std::optional<LightErrors>& lights) {
    if (!lights) return {};
    std::string rows;
    for (const LightRow& row : light_rows(*lights)) {
        rows += "<tr><td class='name'>" + html_escaped(row.light) + "</td>" +
                cells("td", {row.position, row.match, row.position_error.value_or("-"),
                             row.intensity_error.value_or("-"), row.after_factor.value_or("-")}) +
                "</tr>\n";
    }
    return report_table("<th>Light</th>" + cells("th", {"Position, m", "Match", "Position error",
                                                        "Intensity error, RGB", "After the common factor"}),
                        rows);
}

std::string segmentation_table(const Evaluation& evaluation) {
    std::string rows;
    for (size_t i = 0; i < evaluation.objects.size(); ++i) {
        const auto& segmentation = evaluation.objects[i].segmentation;
        if (!segmentation) continue;
        const auto percent = [](double share) { return fmt::format("{:.1f}%", 100 * share); };
        rows +=
            fmt::format("<tr><td>{} {}</td>{}</tr>\n", short_name(i), html_escaped(evaluation.objects[i].name),
                        cells("td", {segmentation->best_label ? fmt::format("{}", *segmentation->best_label) : "-",
                                     fmt::format("{:.3f}", segmentation->iou), percent(segmentation->best_label_share),
                                     fmt::format("{}", segmentation->labels), percent(segmentation->foreign_share)}));
    }
    if (rows.empty()) return {};
    return report_table("<th>Object</th>" + cells("th", {"Best label", "IoU", "Of the object in it",
                                                         "Labels on the object", "Of the label on others"}),
                        rows);
}

std::string plot_rows(const std::vector<PlotRow>& rows, std::string_view explanation) {
    if (rows.empty()) return {};
    std::string html = paragraph(explanation);
    for (const PlotRow& row : rows) html += sub_heading(row.title) + plot_grid(row.plots);
    return html;
}

/// `beyond` says what else has the last colour.
std::string scale(const ColorScale& scale, const char* beyond = "") {
    return fmt::format("<span>{}</span>{}<span>{}{}</span>", html_escaped(scale.low), embedded(scale.png, ""), beyond,
                       html_escaped(scale.high));
}

std::string figure(const std::string& png, const std::string& alt, const std::string& caption_html) {
    return fmt::format("<figure>{}<figcaption>{}</figcaption></figure>\n", embedded(png, alt), caption_html);
}

std::string error_row(const ErrorRow& row, uint32_t frame) {
    const auto alt = [&](const char* what) { return fmt::format("{}, {}, frame {}", row.title, what, frame); };
    const auto caption = [&](const char* what) { return fmt::format("<b>{}</b> {}", html_escaped(row.title), what); };
    const std::string values = row.values ? scale(*row.values) : std::string();
    return figure(row.truth, alt("truth"), caption("truth") + values) +
           figure(row.run, alt("reconstruction"), caption("reconstruction") + values) +
           figure(row.error, alt("absolute error"), caption("error") + scale(row.errors, "&ge; "));
}

std::string error_pictures(std::span<const ErrorFigure> figures) {
    if (figures.empty()) return {};
    const auto key = [](const std::string& png, const char* look, const char* meaning) {
        return fmt::format("<span class='meaning'>{} {}</span>", embedded(png, look, " class='sample'"), meaning);
    };
    std::string html = fmt::format(
        "<p>Absolute differences, averaged over the channels. Colours are encoded for sRGB.{}{}</p>\n",
        key(unfilled_sample(), "hatched:", "the run has no value"), key(no_truth_sample(), "grey:", "no truth"));
    for (const ErrorFigure& figure : figures) {
        html += sub_heading(fmt::format("Frame {}", figure.frame)) + "<div class='errors'>\n";
        for (const ErrorRow& row : figure.rows) html += error_row(row, figure.frame);
        html += "</div>\n";
    }
    return html;
}

}  // namespace

std::string eval_report_html(const Evaluation& evaluation, std::span<const ErrorFigure> figures) {
    const std::string title = "Evaluation of " + evaluation.run;
    std::string html = fmt::format("<h1>{}</h1>\n<p class='quiet'>Compared with the truth of {}</p>\n",
                                   html_escaped(title), html_escaped(evaluation.sequence));
    html += facts(evaluation);
    html += report_section("Not measured", report_warnings(absences(evaluation)));
    html += report_section("Averages, of all frames and of the last tenth", averages(evaluation));
    for (const ViewsSection& section : views_sections(evaluation))
        html += report_section(section.title, metric_tables(summary_table(section.views)));
    html += report_section("Scores per object", scores(evaluation, Pixels::kAll));
    html += report_section("Scores per object, filled pixels", scores(evaluation, Pixels::kFilled));
    if (evaluation.seen_frames > 1)
        html += report_section("Scores per object, where it was seen often", scores(evaluation, Pixels::kSeen));
    html += report_section("Geometry, trajectory, segmentation, lights", finding_table(evaluation));
    html += report_section("Lights", light_table(evaluation.lights));
    html += report_section("Segmentation per object", segmentation_table(evaluation));
    html += report_section(
        "Reconstructed parameters over time",
        plot_rows(value_plots(evaluation), "Means over each object's region. Gaps: the object is not seen."));
    html += report_section("Errors over time", plot_rows(error_plots(evaluation),
                                                         "Mean absolute deviation over all of each object's pixels."));
    html += report_section("Error pictures", error_pictures(figures));
    return report_page(title, html, std::string(plot_style()) + std::string(kStyle));
}

}  // namespace patina::eval
