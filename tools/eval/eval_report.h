#pragma once

#include <span>
#include <string>

#include "tools/eval/error_figures.h"
#include "tools/eval/result.h"

namespace patina::eval {

/// The text of an evaluation's report.html: Table 1, plots over time in the style of the paper's Figures 4 and 5, and
/// error pictures, in one file that needs no other and no network. Reads in light and dark themes and on paper.
std::string eval_report_html(const Evaluation& evaluation, std::span<const ErrorFigure> figures);

}  // namespace patina::eval
