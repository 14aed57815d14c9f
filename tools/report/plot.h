#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace patina {

/// What a line of a plot stands for, which decides how it is drawn.
enum class LineRole {
    kTruth,     ///< bold and pale
    kEstimate,  ///< thin, in the plot's hue
    kRefined,   ///< thin, grey and dashed
};

/// One line of a plot.
struct PlotLine {
    std::string name;
    LineRole role = LineRole::kEstimate;
    std::vector<double> y;  ///< one per x of the plot; what is not finite is a gap
};

/// An interval of an axis.
struct PlotRange {
    double low = 0, high = 0;
    bool operator==(const PlotRange&) const = default;
};

/// A plot of lines over frame numbers.
struct Plot {
    std::string title;
    std::string y_label;
    std::vector<double> x;  ///< frame numbers, ascending
    std::vector<PlotLine> lines;
    size_t hue = 0;                    ///< of the estimate and the truth: plots of one object share it
    std::optional<PlotRange> y_range;  ///< to be covered; without it, that of the values
};

/// Evenly spaced round numbers, multiples of 1, 2 or 5 times a power of ten.
struct Ticks {
    double first_step = 0;  ///< the first tick in steps: a whole number
    double step = 1;
    int count = 0;

    double at(int i) const { return (first_step + i) * step; }
    PlotRange range() const { return {at(0), at(count - 1)}; }
    /// With as many decimals as the step has; 3 significant digits where that would be long.
    std::string label(int i) const;
};

/// The fewest-digits ticks that cover `range` with at most `most_steps` steps (at least 1), each at least
/// `smallest_step`. A range without length is widened around its value.
Ticks nice_ticks(PlotRange range, int most_steps, double smallest_step = 0);

/// The range of all finite values of these plots' lines, for plots that are to be compared; empty without any.
std::optional<PlotRange> range_of(std::span<const Plot> plots);

/// The plot as an inline SVG element that takes its colours from plot_style(): axes with round ticks, and one path per
/// line that breaks at gaps. A title and a description in words are in it for those who cannot see it. Many more points
/// than the width can show are thinned to the lowest and highest of each column. Throws Error when a line has another
/// number of values than x.
std::string plot_svg(const Plot& plot);

/// Small multiples: the plots beside and below each other under one legend with the roles that occur, which says what
/// they stand for in the lines' own names. Markup for a report page; nothing for no plots.
std::string plot_grid(std::span<const Plot> plots);

/// The CSS of plots, for report_page().
std::string_view plot_style();

}  // namespace patina
