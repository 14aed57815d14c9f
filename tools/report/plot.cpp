#include "tools/report/plot.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "engine/core/error.h"
#include "export/html.h"

namespace patina {
namespace {

// In the SVG's own units, which are about a pixel each where four plots stand beside each other.
constexpr double kWidth = 280, kHeight = 160;
constexpr double kLeft = 42, kRight = 8, kTop = 24, kBottom = 32;
constexpr double kColumn = 2;  ///< width below which points are not told apart

constexpr size_t kHues = 6;
constexpr int kMostStepsX = 5, kMostStepsY = 5;

constexpr std::array<std::string_view, 3> kClasses{"truth", "estimate", "refined"};

// Hues: Okabe and Ito's palette, which the colour-blind can tell apart, with its lightest ones darkened on white.
constexpr std::string_view kPlotStyle = R"css(
:root { --hue0: #0072b2; --hue1: #c65600; --hue2: #00835f; --hue3: #a8528a; --hue4: #2b87b8; --hue5: #a87000; }
@media (prefers-color-scheme: dark) {
  :root { --hue0: #56a8e0; --hue1: #f08a45; --hue2: #34c397; --hue3: #dd93bd; --hue4: #8cc9ee; --hue5: #e6b040; }
}
@media print {
  :root { --hue0: #0072b2; --hue1: #c65600; --hue2: #00835f; --hue3: #a8528a; --hue4: #2b87b8; --hue5: #a87000; }
  svg.plot { break-inside: avoid; }
  .legend { break-after: avoid; }
}
.hue0 { color: var(--hue0); } .hue1 { color: var(--hue1); } .hue2 { color: var(--hue2); }
.hue3 { color: var(--hue3); } .hue4 { color: var(--hue4); } .hue5 { color: var(--hue5); }
.plots { display: grid; grid-template-columns: repeat(auto-fill, minmax(15rem, 1fr)); gap: .6rem .8rem; }
svg.plot { display: block; width: 100%; height: auto; }
svg.plot text { fill: var(--quiet); font: 10.5px system-ui, sans-serif; }
svg.plot text.title { fill: var(--text); font-weight: 600; font-size: 12px; }
svg.plot .y { text-anchor: end; }
svg.plot .x, svg.plot .none { text-anchor: middle; }
svg.plot path, svg.key path { fill: none; stroke: currentColor; stroke-linecap: round; stroke-linejoin: round; }
svg.plot path.grid { stroke: var(--line); stroke-width: .7; stroke-linecap: butt; }
path.truth { stroke-width: 4; stroke-opacity: .5; }
path.estimate { stroke-width: 1.3; }
svg.plot path.refined, svg.key path.refined { stroke: var(--quiet); stroke-width: 1.3; stroke-dasharray: 4 2.5; }
.legend { display: flex; flex-wrap: wrap; gap: .2rem 1.4rem; margin: 0 0 .4rem; color: var(--quiet); font-size: .85rem; }
.legend svg { width: 2.2rem; height: .8rem; vertical-align: -.1rem; margin-right: .4rem; }
)css";

struct Point {
    double x = 0, y = 0;
};

/// Maps values to the SVG's units.
struct Axes {
    PlotRange x, y;

    Point place(double at_x, double at_y) const {
        return {kLeft + fraction(at_x, x) * (kWidth - kLeft - kRight),
                kHeight - kBottom - fraction(at_y, y) * (kHeight - kTop - kBottom)};
    }
    /// The middle of a range without length.
    static double fraction(double value, PlotRange range) {
        return range.high > range.low ? (value - range.low) / (range.high - range.low) : 0.5;
    }
};

void widen(std::optional<PlotRange>& range, double value) {
    if (!std::isfinite(value)) return;
    range = range ? PlotRange{std::min(range->low, value), std::max(range->high, value)} : PlotRange{value, value};
}

/// Points of which several share a column become that column's lowest and highest, in their order.
std::vector<Point> thinned(const std::vector<Point>& points) {
    const auto column = [](Point point) { return std::floor(point.x / kColumn); };
    const auto lower = [](Point a, Point b) { return a.y > b.y; };  // SVG's y points down
    std::vector<Point> kept;
    for (auto first = points.begin(); first != points.end();) {
        const auto end =
            std::find_if(first, points.end(), [&](Point point) { return column(point) != column(*first); });
        const auto [low, high] = std::minmax_element(first, end, lower);
        kept.push_back(*std::min(low, high));
        if (low != high) kept.push_back(*std::max(low, high));
        first = end;
    }
    return kept;
}

/// A point alone becomes a dot: a line of no length, which its round caps make visible.
std::string path_data(const std::vector<Point>& points) {
    std::string data;
    for (const Point& point : thinned(points)) {
        data += fmt::format("{}{:.1f} {:.1f}", data.empty() ? "M" : "L", point.x, point.y);
    }
    return points.size() == 1 ? data + "h0" : data;
}

std::string line_svg(const Plot& plot, const PlotLine& line, const Axes& axes) {
    std::string data;
    std::vector<Point> connected;
    const auto flush = [&] {
        data += path_data(connected);
        connected.clear();
    };
    for (size_t i = 0; i < plot.x.size(); ++i) {
        if (std::isfinite(line.y[i])) {
            connected.push_back(axes.place(plot.x[i], line.y[i]));
        } else {
            flush();
        }
    }
    flush();
    if (data.empty()) return {};
    return fmt::format("<path class='{}' d='{}'/>\n", kClasses[static_cast<size_t>(line.role)], data);
}

std::string axes_svg(const Axes& axes, const Ticks& x_ticks, const Ticks& y_ticks) {
    std::string lines, labels;
    for (int i = 0; i < y_ticks.count; ++i) {
        const double y = axes.place(axes.x.low, y_ticks.at(i)).y;
        lines += fmt::format("M{} {:.1f}H{}", kLeft, y, kWidth - kRight);
        labels += fmt::format("<text class='y' x='{}' y='{:.1f}'>{}</text>\n", kLeft - 5, y + 3.5, y_ticks.label(i));
    }
    for (int i = 0; i < x_ticks.count; ++i) {
        if (x_ticks.at(i) < axes.x.low || x_ticks.at(i) > axes.x.high) continue;
        const double x = axes.place(x_ticks.at(i), axes.y.low).x;
        lines += fmt::format("M{:.1f} {}v4", x, kHeight - kBottom);
        labels += fmt::format("<text class='x' x='{:.1f}' y='{}'>{}</text>\n", x, kHeight - 17, x_ticks.label(i));
    }
    labels += fmt::format("<text class='x' x='{}' y='{}'>frame</text>\n", (kLeft + kWidth - kRight) / 2, kHeight - 4);
    return fmt::format("<path class='grid' d='{}'/>\n{}", lines, labels);
}

/// The line in words: "true value 0.5; estimate 0.41 to 0.62, mean 0.55".
std::string in_words(const PlotLine& line) {
    std::optional<PlotRange> range;
    double sum = 0, count = 0;
    for (const double value : line.y) {
        widen(range, value);
        if (!std::isfinite(value)) continue;
        sum += value;
        ++count;
    }
    if (!range) return line.name + " without values";
    if (range->low == range->high) return fmt::format("{} {:.3g}", line.name, range->low);
    return fmt::format("{} {:.3g} to {:.3g}, mean {:.3g}", line.name, range->low, range->high, sum / count);
}

std::string description(const Plot& plot) {
    std::string text = plot.y_label.empty() ? "Over frames" : plot.y_label + " over frames";
    for (const PlotLine& line : plot.lines) text += (&line == plot.lines.data() ? ": " : "; ") + in_words(line);
    return text + ".";
}

std::string legend(std::span<const Plot> plots) {
    std::array<std::optional<std::string>, kClasses.size()> names;
    for (const Plot& plot : plots) {
        for (const PlotLine& line : plot.lines) names[static_cast<size_t>(line.role)] = line.name;
    }
    std::string html;
    for (size_t role = 0; role < kClasses.size(); ++role) {
        if (!names[role]) continue;
        html += fmt::format(
            "<span><svg class='key' viewBox='0 0 36 10' aria-hidden='true'><path class='{}' d='M3 "
            "5H33'/></svg>{}</span>\n",
            kClasses[role], html_escaped(*names[role]));
    }
    return html.empty() ? html : "<p class='legend'>\n" + html + "</p>\n";
}

}  // namespace

std::string Ticks::label(int i) const {
    // A step of 2 x 10^-3 has 3 decimals; the small addition keeps 10^-3 itself from becoming 4.
    const int decimals = std::max(0, static_cast<int>(std::ceil(-std::log10(step) - 1e-9)));
    const bool is_long = decimals > 4 || std::max(std::abs(at(0)), std::abs(at(count - 1))) >= 1e6;
    return is_long ? fmt::format("{:.3g}", at(i)) : fmt::format("{:.{}f}", at(i), decimals);
}

Ticks nice_ticks(PlotRange range, int most_steps, double smallest_step) {
    PATINA_ASSERT(std::isfinite(range.high - range.low) && most_steps > 0, "range ", range.low, " to ", range.high,
                  " in ", most_steps, " steps");
    if (!(range.high > range.low)) {
        const double margin = range.low == 0 ? 0.5 : std::abs(range.low) / 2;
        range = {range.low - margin, range.low + margin};
    }
    const double least = std::max((range.high - range.low) / most_steps, smallest_step);
    double power = std::pow(10.0, std::floor(std::log10(least)));
    for (;; power *= 10) {
        for (const double factor : {1.0, 2.0, 5.0}) {
            const double step = factor * power;
            if (step < smallest_step) continue;
            // What differs from a tick by rounding alone needs no further tick.
            const double first = std::floor(range.low / step + 1e-9) + 0.0;  // + 0 turns -0 into 0
            const double last = std::ceil(range.high / step - 1e-9);
            if (last - first <= most_steps) return {first, step, static_cast<int>(last - first) + 1};
        }
    }
}

std::optional<PlotRange> range_of(std::span<const Plot> plots) {
    std::optional<PlotRange> range;
    for (const Plot& plot : plots) {
        for (const PlotLine& line : plot.lines) {
            for (const double value : line.y) widen(range, value);
        }
    }
    return range;
}

std::string plot_svg(const Plot& plot) {
    for (const PlotLine& line : plot.lines) {
        if (line.y.size() != plot.x.size()) {
            throw Error("plot '", plot.title, "': the line '", line.name, "' has ", line.y.size(), " values for ",
                        plot.x.size(), " frames");
        }
    }
    std::string svg = fmt::format(
        "<svg class='plot hue{}' viewBox='0 0 {} {}' role='img'>\n<title>{}</title>\n<desc>{}</desc>\n"
        "<text class='title' x='{}' y='13'>{}</text>\n",
        plot.hue % kHues, kWidth, kHeight, html_escaped(plot.title), html_escaped(description(plot)), kLeft,
        html_escaped(plot.title));
    const std::optional<PlotRange> values = range_of({&plot, 1});
    if (!values) {
        return svg + fmt::format("<text class='none' x='{}' y='{}'>no values</text>\n</svg>\n",
                                 (kLeft + kWidth - kRight) / 2, kHeight / 2);
    }
    const Ticks y_ticks = nice_ticks(plot.y_range.value_or(*values), kMostStepsY);
    const PlotRange x_range{plot.x.front(), plot.x.back()};
    const Axes axes{x_range, y_ticks.range()};
    svg += axes_svg(axes, nice_ticks(x_range, kMostStepsX, 1), y_ticks);
    for (const PlotLine& line : plot.lines) svg += line_svg(plot, line, axes);
    return svg + "</svg>\n";
}

std::string plot_grid(std::span<const Plot> plots) {
    if (plots.empty()) return {};
    std::string html = legend(plots) + "<div class='plots'>\n";
    for (const Plot& plot : plots) html += plot_svg(plot);
    return html + "</div>\n";
}

std::string_view plot_style() { return kPlotStyle; }

}  // namespace patina
