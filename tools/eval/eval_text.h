#pragma once

#include <string>

#include "tools/eval/result.h"

namespace patina::eval {

/// An evaluation for a terminal of 120 columns: the paper's Table 1 with the coverage, the same with unfilled pixels as
/// zero where there are any, and a line each about depth, normals, trajectory, segmentation and lights. What was not
/// measured is "-", with a note that says why.
std::string eval_text(const Evaluation& evaluation);

}  // namespace patina::eval
