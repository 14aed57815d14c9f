#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tools/eval/result.h"

namespace patina::eval {

/// The colours that values have in a picture.
struct ColorScale {
    std::string png;        ///< one row of pixels from the lowest value to the highest
    std::string low, high;  ///< those values, with their unit
};

/// One quantity in one frame: truth, reconstruction and their absolute difference, averaged over the channels.
struct ErrorRow {
    std::string title;                 ///< "kd refined"
    std::string truth, run, error;     ///< PNG files
    std::optional<ColorScale> values;  ///< of truth and run; empty for colours
    ColorScale errors;                 ///< higher errors have the last colour
};

struct ErrorFigure {
    uint32_t frame = 0;
    std::vector<ErrorRow> rows;  ///< what the run has, in the order of Table 1, then depth
};

/// Pictures of at most three of the evaluated frames, the first, the middle and the last, read from truth/frames and
/// the run's frames again. A quantity has the same scales in all of them, before and after refinement. Pixels without
/// truth are grey, those that only the run lacks are hatched. The pictures shrink until all together have at most
/// kMostFigureBytes. Throws Error when a file is missing or damaged.
std::vector<ErrorFigure> error_figures(const Evaluation& evaluation);

/// Embedded in a page, a third is added.
inline constexpr size_t kMostFigureBytes = 3'000'000;

/// A small hatched picture like the pixels that only the run lacks, and a grey one like those without truth: PNG files
/// for the legend.
std::string unfilled_sample();
std::string no_truth_sample();

}  // namespace patina::eval
