#pragma once

#include <string>
#include <vector>

#include "tools/eval/result.h"

namespace patina::eval {

/// A group of columns beside each other: cells as text, "-" where there is nothing.
struct MetricCells {
    std::string metric;                           ///< "MAD", "PSNR, dB"
    std::vector<std::vector<std::string>> cells;  ///< by row, then column
};

/// The paper's Table 1. Its rows are the quantities, and its columns the objects, S1 to Sn, and their average. With
/// more than kMostObjectColumns objects it is turned: rows are the objects by name, and their average.
struct ScoreTable {
    bool is_turned = false;
    std::vector<std::string> rows, columns;
    std::vector<MetricCells> metrics;
};

inline constexpr size_t kMostObjectColumns = 6;

/// The scores over these pixels, averaged over all frames. Those of all pixels end with the coverage.
ScoreTable score_table(const Evaluation& evaluation, Pixels pixels);

/// The averages over the objects. Its rows are the quantities, its columns the scores; in place of metrics it has every
/// kind of pixels and period.
ScoreTable summary_table(const Evaluation& evaluation);
/// The same over all pixels and the filled ones, and all views.
ScoreTable summary_table(const Views& views);

/// Views that were never recorded, under a title.
struct ViewsSection {
    std::string title;
    const Views& views;
};

/// Those that were measured.
std::vector<ViewsSection> views_sections(const Evaluation& evaluation);

/// "S1" for the first object.
std::string short_name(size_t object);

/// "S1 floor, S2 box": what the columns of Table 1 stand for; empty where it is turned.
std::string column_key(const Evaluation& evaluation);

/// Which of the objects' pixels the scores are over; a sentence.
std::string scored_pixels(const Evaluation& evaluation, Pixels pixels);

/// What a person calls a quantity: "kd", "kd refined", "RGB", "RGB shown".
const char* title_of(Quantity quantity);

/// Notes about what could not be measured, because the run or the sequence does not have it; a sentence each.
std::vector<std::string> absences(const Evaluation& evaluation);

/// A result in words.
struct Finding {
    std::string name;   ///< "Depth error"
    std::string value;  ///< "2.10 mm median, ..."
};

/// What was measured of depth, normals, trajectory, segmentation, intervals and lights.
std::vector<Finding> findings(const Evaluation& evaluation);

/// A true light and what stands for it, or a light that the run invented.
struct LightRow {
    std::string light;                           ///< "true light 1", "light 3 of the run"
    std::string position;                        ///< in metres: "0.10, -2.30, 1.00"
    std::string match;                           ///< "light 2 of the run", "missed", "invented"
    std::optional<std::string> position_error;   ///< "21.0 mm"; this and the following with a match only
    std::optional<std::string> intensity_error;  ///< per channel: "3.2% 3.1% 4.0%"
    std::optional<std::string> after_factor;     ///< likewise, after division by the common factor
};

/// One row per true light, then one per invented light.
std::vector<LightRow> light_rows(const LightErrors& lights);

}  // namespace patina::eval
