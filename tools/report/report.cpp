#include "tools/report/report.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "engine/core/error.h"
#include "export/html.h"
#include "export/viewer/write_viewer.h"
#include "tools/report/plan.h"
#include "tools/report/plot.h"
#include "tools/report/report_tables.h"
#include "tools/report/swatches.h"
#include "tools/report/verdict.h"

namespace patina {
namespace {

constexpr uint64_t kMostOfView = 6'000'000;  // bytes; the report has pictures, too

constexpr std::string_view kStyle = R"css(
.verdict { margin: .8rem 0 0; padding: 0; list-style: none; }
.verdict li { padding: .15rem 0 .15rem 1.7rem; position: relative; }
.verdict span { display: inline-block; }
.verdict span::first-letter { text-transform: uppercase; }
.verdict code { font: inherit; white-space: nowrap; }
.verdict li::before { position: absolute; left: .2rem; font-weight: 700; }
.verdict .good::before { content: "\2713"; color: var(--bar); }
.verdict .unknown::before { content: "?"; color: var(--warn); }
iframe.view { display: block; width: 100%; height: min(75vh, 36rem); border: 1px solid var(--line); border-radius: 4px; }
details { margin-top: 1.2rem; border-bottom: 1px solid var(--line); padding-bottom: .4rem; }
summary { cursor: pointer; font-size: 1.05rem; font-weight: 600; }
details[open] > summary { margin-bottom: .6rem; }
@media (max-width: 40rem) { body { padding: .8rem; } }
@media print { iframe.view { display: none; } }
)css";

/// Why the run ended before its time comes first.
std::vector<std::string> shortfalls_of(const RunSummary& summary) {
    std::vector<std::string> all = summary.shortfalls;
    if (!summary.finished && std::ranges::find(all, summary.ended) == all.end()) all.insert(all.begin(), summary.ended);
    return all;
}

/// A sentence that says what is shown, above it; nothing where nothing is.
std::string explained(std::string_view sentence, const std::string& html) {
    if (html.empty()) return {};
    return fmt::format("<p class='quiet'>{}</p>\n{}", html_escaped(sentence), html);
}

/// A section that opens where it is asked for.
std::string folded(std::string_view title, const std::string& html) {
    if (html.empty()) return {};
    return fmt::format("<details><summary>{}</summary>\n{}</details>\n", html_escaped(title), html);
}

/// The program's options as code, where lines do not break at their dashes.
std::string with_marked_options(std::string_view html) {
    constexpr std::string_view kOptionLetters = "abcdefghijklmnopqrstuvwxyz-";
    std::string marked;
    for (size_t at = html.find("--"); at != std::string_view::npos; at = html.find("--")) {
        const size_t end = std::min(html.find_first_not_of(kOptionLetters, at), html.size());
        marked += fmt::format("{}<code>{}</code>", html.substr(0, at), html.substr(at, end - at));
        html.remove_prefix(end);
    }
    return marked.append(html);
}

/// One point of the verdict.
std::string verdict_item(const char* kind, const std::string& sentence) {
    return fmt::format("<li class='{}'><span>{}</span></li>\n", kind, with_marked_options(html_escaped(sentence)));
}

std::string verdict_list(const RunSummary& summary) {
    const Verdict verdict = verdict_of(summary);
    if (verdict.good.empty() && verdict.unknown.empty()) return {};
    std::string html = "<ul class='verdict'>\n";
    for (const std::string& sentence : verdict.good) html += verdict_item("good", sentence);
    for (const std::string& sentence : verdict.unknown) html += verdict_item("unknown", sentence);
    return html + "</ul>\n";
}

/// Within the page; what does not fit is named.
std::string view_html(const SceneParts& scene) {
    try {
        return fmt::format("<iframe class='view' title='3-D view of the scene' srcdoc=\"{}\"></iframe>\n",
                           html_escaped(viewer_html(scene, {.most_bytes = kMostOfView})));
    } catch (const Error& error) {
        return fmt::format(
            "<p>The view does not fit into this page: {}. <a href='scene.glb'>scene.glb</a> holds it.</p>\n",
            html_escaped(error.what()));
    }
}

std::string tracking_plot(const std::vector<TrackedFrame>& frames) {
    if (frames.size() < 2) return {};
    Plot plot{"Share of the picture that fits the model", "share", {},
              {{"share", LineRole::kEstimate, {}}},       0,       PlotRange{0, 1}};
    for (const TrackedFrame& frame : frames) {
        plot.x.push_back(frame.index);
        const bool lost = frame.report.state == TrackingState::kLost;
        plot.lines.front().y.push_back(lost ? std::numeric_limits<double>::quiet_NaN() : double{frame.report.share});
    }
    return plot_svg(plot);
}

std::string scene_html(const ReportScene& scene, const RunSummary& summary) {
    const auto [low, high] = bounds_of(scene.parts);
    const Lighting lights{scene.parts.lights, scene.parts.ambient};
    return report_section("The scene", view_html(scene.parts)) +
           report_section("Materials",
                          explained("Spheres of each material, the largest objects first, amid this room's "
                                    "lamps. Where gloss was not observed, only the diffuse part is shown.",
                                    swatch_grid(summary.segments, lights, glm::dvec3(low + high) / 2.0))) +
           report_section("Plan",
                          explained("From straight above: the camera's way (pink, the dot is where it begins) and the "
                                    "lamps (yellow).",
                                    plan_svg(scene.parts, scene.path_m)));
}

std::string details_html(const RunSummary& summary) {
    std::string html = folded("Run", facts_list(summary));
    html +=
        folded("Lights", explained("A point at distance r (m) receives intensity / r², in linear pixel values: 1 is "
                                   "the brightest that 8 bits hold.",
                                   light_table(summary.lamps)));
    html += folded("Table of materials",
                   explained("Of Ward's model, by segment: diffuse albedo kd and specular albedo ks (red, green, blue; "
                             "0 to 1), roughness alpha. Confidence is that of kd, from 0 to 1.",
                             segment_table(summary.segments)));
    if (summary.live)
        html += folded("Live", explained("From a frame's exposure until its pose was known, and until a picture of the "
                                         "model from there was.",
                                         live_table(*summary.live)));
    html += folded("Table of tracking", tracking_table(summary.tracking));
    html += folded("GPU time per pass", pass_table(summary.passes));
    html += folded("Device memory", memory_table(summary.memory));
    html += folded("Skipped frames", skipped_table(summary.frames.skipped));
    return html + folded("Settings", settings_text(summary.settings));
}

}  // namespace

std::string report_html(const RunSummary& summary, std::span<const ReportPicture> pictures, const ReportScene* scene,
                        std::span<const PicturePair> pairs) {
    const SequenceInfo& sequence = summary.sequence;
    std::string html = fmt::format(
        "<h1>{}</h1>\n<p class='quiet'>Reconstructed by Patina {} from {} frames ({}), colour {}&times;{}, depth "
        "{}&times;{}</p>\n",
        html_escaped(sequence.name), html_escaped(summary.version), grouped(sequence.frames.value_or(0)),
        html_escaped(sequence.format), sequence.color.extent.width, sequence.color.extent.height,
        sequence.depth.extent.width, sequence.depth.extent.height);
    html += verdict_list(summary);
    html += report_section("Incomplete", report_warnings(shortfalls_of(summary)));
    html += report_section("Warnings", report_warnings(summary.warnings));
    if (scene) html += scene_html(*scene, summary);
    html +=
        report_section("Recorded and re-rendered",
                       explained("Drag the border, or move it with the arrow keys. The re-rendering is from the time "
                                 "of the frame; the finished scene can know more.",
                                 comparison_html(pairs)));
    html +=
        report_section("Pictures", explained("From where the colour camera was, what stands above each panel. Grey: "
                                             "the model has no surface there.",
                                             report_figures(pictures)));
    html += report_section("Tracking", explained("Gaps: the camera was lost.", tracking_plot(summary.tracking)));
    html += report_section("Details", details_html(summary));
    return report_page(sequence.name, html,
                       fmt::format("{}{}{}{}{}", kStyle, plot_style(), plan_style(), swatch_style(),
                                   pairs.empty() ? "" : comparison_style()));
}

}  // namespace patina
