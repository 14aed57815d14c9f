#include "tools/export/report.h"

#include <algorithm>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "tools/export/html.h"

namespace patina {
namespace {

constexpr std::string_view kStyle = R"css(
:root { --ground: #ffffff; --text: #1d2126; --quiet: #5d6670; --line: #d9dde2; --bar: #2f6fb5; --range: #a9c5e3; --warn: #9a4d00; --warn-ground: #fff4e3; }
@media (prefers-color-scheme: dark) {
  :root { --ground: #16191d; --text: #e3e6ea; --quiet: #98a2ad; --line: #333a42; --bar: #6aa9ea; --range: #34506d; --warn: #ffbe73; --warn-ground: #33260f; }
}
@media print {
  :root { --ground: #ffffff; --text: #000000; --quiet: #444444; --line: #bbbbbb; --bar: #2f6fb5; --range: #a9c5e3; --warn: #000000; --warn-ground: #ffffff; }
  body { max-width: none; padding: 0; }
  figure, tr, dl > div { break-inside: avoid; }
  h2 { break-after: avoid; }
  svg { print-color-adjust: exact; -webkit-print-color-adjust: exact; }
}
* { box-sizing: border-box; }
body { margin: 0 auto; max-width: 72rem; padding: 1.5rem; background: var(--ground); color: var(--text); font: 16px/1.5 system-ui, sans-serif; }
h1 { font-size: 1.7rem; line-height: 1.2; margin: 0; overflow-wrap: anywhere; }
h2 { font-size: 1.15rem; margin: 2.2rem 0 .6rem; border-bottom: 1px solid var(--line); padding-bottom: .2rem; }
p.quiet, figcaption { color: var(--quiet); }
p.quiet { margin: .3rem 0 0; }
dl { display: grid; grid-template-columns: repeat(auto-fill, minmax(13rem, 1fr)); gap: .8rem 1.5rem; margin: 1.4rem 0 0; }
dt { color: var(--quiet); font-size: .85rem; }
dt::first-letter { text-transform: uppercase; }
dd { margin: 0; font-weight: 600; overflow-wrap: anywhere; }
figure { margin: 0 0 1rem; }
figure img { display: block; width: 100%; height: auto; border-radius: 4px; }
figcaption { font-size: .85rem; margin-top: .25rem; }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; width: 100%; font-variant-numeric: tabular-nums; }
th, td { padding: .25rem .8rem .25rem 0; text-align: left; border-bottom: 1px solid var(--line); vertical-align: middle; }
th { color: var(--quiet); font-weight: 400; font-size: .85rem; }
.number { text-align: right; white-space: nowrap; }
td.bar { width: 35%; min-width: 8rem; padding-right: 0; }
td.bar svg { display: block; width: 100%; height: .8rem; }
rect.value { fill: var(--bar); }
rect.range { fill: var(--range); }
tfoot td { border-bottom: 0; font-weight: 600; }
.warnings { background: var(--warn-ground); color: var(--warn); border-left: 4px solid var(--warn); padding: .6rem 1rem .6rem 2rem; margin: 0; }
pre { overflow-x: auto; font-size: .85rem; border: 1px solid var(--line); border-radius: 4px; padding: .8rem; margin: 0; }
)css";

std::string grouped(uint64_t value) {
    std::string digits = fmt::format("{}", value);
    for (size_t end = digits.size(); end > 3; end -= 3) digits.insert(end - 3, "&#8239;");
    return digits;
}

std::string mebibytes(uint64_t bytes) { return fmt::format("{:.1f} MiB", static_cast<double>(bytes) / (1 << 20)); }

double fraction(double part, double whole) { return whole > 0 ? std::clamp(part / whole, 0.0, 1.0) : 0.0; }

/// A bar over a hundred units from 0 to `value` (a fraction), over a paler one from `low` to `high`.
std::string bar_svg(double low, double value, double high) {
    return fmt::format(
        "<svg viewBox='0 0 100 8' preserveAspectRatio='none' aria-hidden='true'>"
        "<rect x='{:.2f}' y='3' width='{:.2f}' height='2' class='range'/>"
        "<rect x='0' y='1' width='{:.2f}' height='6' class='value'/></svg>",
        100 * low, 100 * std::max(0.0, high - low), 100 * value);
}

/// A section, or nothing where there is nothing to show.
std::string section(std::string_view title, const std::string& content) {
    return content.empty() ? std::string() : fmt::format("<h2>{}</h2>\n{}\n", html_escaped(title), content);
}

std::string fact(std::string_view name, const std::string& html) {
    return fmt::format("<div><dt>{}</dt><dd>{}</dd></div>\n", html_escaped(name), html);
}

std::string facts(const RunRecord& record) {
    const FrameLedger& frames = record.frames;
    const VoxelPoolRecord& pool = record.voxel_pool;
    std::string html =
        fact("Frames used", fmt::format("{} of {}", grouped(frames.used), grouped(record.sequence.frames)));
    html += fact("Frames skipped", grouped(frames.skipped.size()));
    html += fact("Voxel blocks", fmt::format("{} of {}", grouped(pool.blocks_used), grouped(pool.blocks_capacity)));
    if (pool.blocks_refused > 0) html += fact("Voxel blocks refused", grouped(pool.blocks_refused));
    for (const auto& [name, count] : record.totals) html += fact(name, grouped(count));
    for (const auto& [name, seconds] : record.times_s) html += fact("Time, " + name, fmt::format("{:.2f} s", seconds));
    html += fact("Device", html_escaped(record.device.name));
    html += fact("Driver", html_escaped(record.device.driver));
    html += fact("Seed", fmt::format("{}", record.seed));
    return "<dl>\n" + html + "</dl>\n";
}

std::string warning_list(const std::vector<std::string>& warnings) {
    if (warnings.empty()) return {};
    std::string html = "<ul class='warnings'>\n";
    for (const std::string& warning : warnings) html += "<li>" + html_escaped(warning) + "</li>\n";
    return html + "</ul>";
}

std::string figures(std::span<const ReportPicture> pictures) {
    std::string html;
    for (const ReportPicture& picture : pictures) {
        const std::string caption = html_escaped(picture.caption);
        html += fmt::format(
            "<figure><img alt=\"{}\" src=\"data:image/png;base64,{}\"><figcaption>{}</figcaption></figure>\n", caption,
            base64(picture.png), caption);
    }
    return html;
}

std::string table(std::string_view head, const std::string& rows, const std::string& foot = {}) {
    return fmt::format("<div class='scroll'><table>\n<thead><tr>{}</tr></thead>\n<tbody>\n{}</tbody>\n{}</table></div>",
                       head, rows, foot);
}

std::string pass_row(const PassTime& pass, double longest_ms) {
    return fmt::format(
        "<tr><td>{}</td><td class='number'>{}</td><td class='number'>{:.3f}</td><td class='number'>{:.3f}</td>"
        "<td class='number'>{:.3f}</td><td class='bar'>{}</td></tr>\n",
        html_escaped(pass.name), grouped(pass.count), pass.min_ms, pass.median_ms, pass.max_ms,
        bar_svg(fraction(pass.min_ms, longest_ms), fraction(pass.median_ms, longest_ms),
                fraction(pass.max_ms, longest_ms)));
}

/// Bars are drawn to twice the longest median, so that one slow first frame does not flatten them all.
std::string pass_table(const std::vector<PassTime>& passes) {
    if (passes.empty()) return {};
    double longest_ms = 0, sum_ms = 0;
    for (const PassTime& pass : passes) {
        longest_ms = std::max(longest_ms, 2 * pass.median_ms);
        sum_ms += pass.median_ms;
    }
    std::string rows;
    for (const PassTime& pass : passes) rows += pass_row(pass, longest_ms);
    return table(
        "<th>Pass</th><th class='number'>Runs</th><th class='number'>Min, ms</th><th class='number'>Median, ms</th>"
        "<th class='number'>Max, ms</th><th>Median (bar), min to max (line)</th>",
        rows,
        fmt::format(
            "<tfoot><tr><td>Sum of medians</td><td></td><td></td><td class='number'>{:.3f}</td><td></td><td></td></tr>"
            "</tfoot>\n",
            sum_ms));
}

std::string memory_table(const std::vector<MemoryRecord>& pools) {
    if (pools.empty()) return {};
    std::string rows;
    uint64_t bytes = 0;
    for (const MemoryRecord& pool : pools) {
        bytes += pool.bytes;
        rows += fmt::format(
            "<tr><td>{}</td><td class='number'>{}</td><td class='number'>{}</td><td class='number'>{}</td>"
            "<td class='bar'>{}</td></tr>\n",
            html_escaped(pool.name), mebibytes(pool.bytes), grouped(pool.used), grouped(pool.capacity),
            bar_svg(0, fraction(static_cast<double>(pool.used), static_cast<double>(pool.capacity)), 1));
    }
    return table(
        "<th>Pool</th><th class='number'>Size</th><th class='number'>Used</th><th class='number'>Capacity</th>"
        "<th>Filled</th>",
        rows,
        fmt::format("<tfoot><tr><td>Sum</td><td class='number'>{}</td><td></td><td></td><td></td></tr></tfoot>\n",
                    mebibytes(bytes)));
}

std::string skipped_table(const std::vector<sensor::Skipped>& skipped) {
    if (skipped.empty()) return {};
    std::string rows;
    for (const sensor::Skipped& frame : skipped) {
        rows +=
            fmt::format("<tr><td class='number'>{}</td><td>{}</td></tr>\n", frame.index, html_escaped(frame.reason));
    }
    return table("<th class='number'>Frame</th><th>Reason</th>", rows);
}

std::string settings_text(const nlohmann::ordered_json& settings) {
    if (settings.empty()) return {};
    const std::string text = settings.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
    return "<pre>" + html_escaped(text) + "</pre>";
}

}  // namespace

std::string report_html(const RunRecord& record, std::span<const ReportPicture> pictures) {
    const sensor::SequenceInfo& sequence = record.sequence;
    const std::string title = html_escaped(sequence.name) + " &middot; Patina";
    std::string html = fmt::format(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
        "<meta name=\"color-scheme\" content=\"light dark\">\n<title>{}</title>\n<style>{}</style>\n</head>\n<body>\n",
        title, kStyle);
    html += fmt::format(
        "<h1>{}</h1>\n<p class='quiet'>Reconstructed by Patina {} from {} frames ({}), colour {}&times;{}, depth "
        "{}&times;{}</p>\n",
        html_escaped(sequence.name), html_escaped(record.version), grouped(sequence.frames),
        html_escaped(sequence.format), sequence.color.extent.width, sequence.color.extent.height,
        sequence.depth.extent.width, sequence.depth.extent.height);
    html += facts(record);
    html += section("Warnings", warning_list(record.warnings));
    html += section("Pictures", figures(pictures));
    html += section("GPU time per pass", pass_table(record.passes));
    html += section("Device memory", memory_table(record.memory));
    html += section("Skipped frames", skipped_table(record.frames.skipped));
    html += section("Settings", settings_text(record.settings));
    return html + "</body>\n</html>\n";
}

}  // namespace patina
