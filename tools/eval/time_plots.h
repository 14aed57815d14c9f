#pragma once

#include <string>
#include <vector>

#include "tools/eval/result.h"
#include "tools/report/plot.h"

namespace patina::eval {

/// A row of small plots over time, one per object, on one scale.
struct PlotRow {
    std::string title;  ///< "Diffuse albedo kd, red channel"
    std::vector<Plot> plots;
};

/// As the paper's Figure 4: the mean of each object's true and reconstructed parameters, of colours the red channel,
/// before and after refinement. Rows of what the run has; gaps where an object is not seen.
std::vector<PlotRow> value_plots(const Evaluation& evaluation);

/// As the paper's Figure 5: the mean absolute deviation of each object, before and after refinement.
std::vector<PlotRow> error_plots(const Evaluation& evaluation);

}  // namespace patina::eval
