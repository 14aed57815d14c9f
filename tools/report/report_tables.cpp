#include "tools/report/report_tables.h"

#include <algorithm>

#include <fmt/format.h>

#include "export/html.h"
#include "tools/report/report_page.h"
#include "tools/report/verdict.h"

namespace patina {
namespace {

constexpr const char* kNotObserved = "not observed";

std::string size_text(uint64_t bytes) { return fmt::format("{:.1f} MiB", static_cast<double>(bytes) / (1 << 20)); }

double fraction(double part, double whole) { return whole > 0 ? std::clamp(part / whole, 0.0, 1.0) : 0.0; }

/// A bar over a hundred units from 0 to `value` (a fraction), over a paler one from `low` to `high`.
std::string bar_svg(double low, double value, double high) {
    return fmt::format(
        "<svg viewBox='0 0 100 8' preserveAspectRatio='none' aria-hidden='true'>"
        "<rect x='{:.2f}' y='3' width='{:.2f}' height='2' class='range'/>"
        "<rect x='0' y='1' width='{:.2f}' height='6' class='value'/></svg>",
        100 * low, 100 * std::max(0.0, high - low), 100 * value);
}

std::string vector_text(glm::dvec3 v) { return fmt::format("{:.3f} {:.3f} {:.3f}", v.x, v.y, v.z); }

std::string pass_row(const PassTime& pass, double longest_ms) {
    return fmt::format(
        "<tr><td>{}</td><td class='number'>{}</td><td class='number'>{:.3f}</td><td class='number'>{:.3f}</td>"
        "<td class='number'>{:.3f}</td><td class='bar'>{}</td></tr>\n",
        html_escaped(pass.name), grouped(pass.count), pass.min_ms, pass.median_ms, pass.max_ms,
        bar_svg(fraction(pass.min_ms, longest_ms), fraction(pass.median_ms, longest_ms),
                fraction(pass.max_ms, longest_ms)));
}

std::string vector_text(const std::optional<glm::vec3>& v) { return v ? vector_text(glm::dvec3(*v)) : kNotObserved; }

std::string segment_row(const SegmentSummary& segment) {
    const SegmentReflectance& known = segment.reflectance;
    const bool gloss = gloss_is_observed(known);
    return fmt::format(
        "<tr><td class='number'>{}</td><td>{}</td><td class='number'>{}</td><td class='number'>{}</td>"
        "<td class='number'>{}</td><td class='number'>{}</td><td class='number'>{}</td><td class='number'>{:.2f}</td>"
        "</tr>\n",
        segment.id, html_escaped(segment.name), vector_text(known.kd),
        gloss ? vector_text(glm::dvec3(known.gloss->ks)) : kNotObserved,
        gloss ? fmt::format("{:.3f}", known.gloss->alpha) : kNotObserved, grouped(known.voxels),
        grouped(known.observations), known.confidence);
}

}  // namespace

std::string facts_list(const RunSummary& summary) {
    const FrameLedger& frames = summary.frames;
    const VoxelPoolSummary& pool = summary.voxel_pool;
    std::string html = report_fact(
        "Frames used", fmt::format("{} of {}", grouped(frames.used), grouped(summary.sequence.frames.value_or(0))));
    if (!summary.detail.empty())
        html += report_fact("Detail", html_escaped(fmt::format("{}, since {}", summary.detail.value("level", ""),
                                                               summary.detail.value("because", ""))));
    html += report_fact("Frames skipped", grouped(frames.skipped.size()));
    if (frames.repeated > 0) html += report_fact("Frames that repeat the one before", grouped(frames.repeated));
    if (frames.undone > 0) html += report_fact("Frames undone", grouped(frames.undone));
    html +=
        report_fact("Voxel blocks", fmt::format("{} of {}", grouped(pool.blocks_used), grouped(pool.blocks_capacity)));
    if (pool.blocks_refused > 0) html += report_fact("Voxel blocks refused", grouped(pool.blocks_refused));
    if (const auto& observed = summary.observation_pool) {
        html += report_fact("Observed voxels", fmt::format("{} of {}", grouped(observed->records_used),
                                                           grouped(observed->records_capacity)));
        if (observed->records_refused > 0)
            html += report_fact("Observed voxels refused", grouped(observed->records_refused));
    }
    for (const auto& [name, count] : summary.totals) html += report_fact(name, grouped(count));
    for (const auto& [name, seconds] : summary.times_s)
        html += report_fact("Time, " + name, fmt::format("{:.2f} s", seconds));
    if (summary.ambient != glm::dvec3(0)) html += report_fact("Ambient light, RGB", vector_text(summary.ambient));
    if (summary.world_offset_m != glm::dvec3(0))
        html += report_fact("World moved by, m", vector_text(summary.world_offset_m));
    html += report_fact("Device", html_escaped(summary.device.name));
    html += report_fact("Driver", html_escaped(summary.device.driver));
    html += report_fact("Seed", fmt::format("{}", summary.seed));
    return report_facts(html);
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
    return report_table(
        "<th>Pass</th><th class='number'>Runs</th><th class='number'>Min, ms</th><th class='number'>Median, ms</th>"
        "<th class='number'>Max, ms</th><th>Median (bar), min to max (line)</th>",
        rows,
        fmt::format(
            "<tfoot><tr><td>Sum of medians</td><td></td><td></td><td class='number'>{:.3f}</td><td></td><td></td></tr>"
            "</tfoot>\n",
            sum_ms));
}

std::string memory_table(const std::vector<MemorySummary>& pools) {
    if (pools.empty()) return {};
    std::string rows;
    uint64_t bytes = 0;
    for (const MemorySummary& pool : pools) {
        bytes += pool.bytes;
        rows += fmt::format(
            "<tr><td>{}</td><td class='number'>{}</td><td class='number'>{}</td><td class='number'>{}</td>"
            "<td class='bar'>{}</td></tr>\n",
            html_escaped(pool.name), size_text(pool.bytes), grouped(pool.used), grouped(pool.capacity),
            bar_svg(0, fraction(static_cast<double>(pool.used), static_cast<double>(pool.capacity)), 1));
    }
    return report_table(
        "<th>Pool</th><th class='number'>Size</th><th class='number'>Used</th><th class='number'>Capacity</th>"
        "<th>Filled</th>",
        rows,
        fmt::format("<tfoot><tr><td>Sum</td><td class='number'>{}</td><td></td><td></td><td></td></tr></tfoot>\n",
                    size_text(bytes)));
}

std::string light_table(const std::vector<Light>& lights) {
    if (lights.empty()) return {};
    std::string rows;
    for (const Light& light : lights) {
        rows += fmt::format("<tr><td class='number'>{}</td><td class='number'>{}</td><td class='number'>{}</td></tr>\n",
                            vector_text(light.position_m), vector_text(light.intensity),
                            light.radius_m > 0 ? fmt::format("{:.1f}", 100 * light.radius_m) : "");
    }
    return report_table(
        "<th class='number'>Position, m</th><th class='number'>Intensity, RGB</th><th class='number'>Radius, cm</th>",
        rows);
}

std::string segment_table(const std::vector<SegmentSummary>& segments) {
    if (segments.empty()) return {};
    std::string rows;
    for (const SegmentSummary& segment : segments) rows += segment_row(segment);
    return report_table(
        "<th class='number'>Segment</th><th>Name</th><th class='number'>kd</th><th class='number'>ks</th>"
        "<th class='number'>alpha</th><th class='number'>Voxels</th><th class='number'>Observations</th>"
        "<th class='number'>Confidence</th>",
        rows);
}

std::string skipped_table(const std::vector<Skipped>& skipped) {
    if (skipped.empty()) return {};
    std::string rows;
    for (const Skipped& frame : skipped) {
        rows +=
            fmt::format("<tr><td class='number'>{}</td><td>{}</td></tr>\n", frame.index, html_escaped(frame.reason));
    }
    return report_table("<th class='number'>Frame</th><th>Reason</th>", rows);
}

std::string settings_text(const nlohmann::ordered_json& settings) {
    if (settings.empty()) return {};
    const std::string text = settings.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
    return "<pre>" + html_escaped(text) + "</pre>";
}

}  // namespace patina
