#include "tools/eval/eval_text.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "engine/core/printable.h"
#include "tools/eval/table.h"

namespace patina::eval {
namespace {

constexpr size_t kTerminalColumns = 120;
constexpr size_t kLongestName = 22;
constexpr size_t kShortestCell = 7;

bool continues_character(char byte) { return (static_cast<unsigned char>(byte) & 0xc0) == 0x80; }

/// Code points, which for names are as good as columns.
size_t length_of(const std::string& text) {
    return static_cast<size_t>(std::ranges::count_if(text, [](char byte) { return !continues_character(byte); }));
}

std::string shortened(std::string name) {
    if (length_of(name) <= kLongestName) return name;
    while (length_of(name) >= kLongestName) name.pop_back();
    return name + "~";
}

std::string padded(const std::string& text, size_t width) {
    return text + std::string(width - std::min(width, length_of(text)), ' ');
}

std::string right(const std::string& text, size_t width) {
    return std::string(width - std::min(width, length_of(text)), ' ') + text;
}

std::string centred(const std::string& text, size_t width) {
    return padded(std::string((width - std::min(width, length_of(text))) / 2, ' ') + text, width);
}

std::string trimmed(std::string line) {
    line.erase(line.find_last_not_of(' ') + 1);
    return line + '\n';
}

/// As many metrics beside each other as the terminal has room for, then the next below.
class MetricPrinter {
  public:
    explicit MetricPrinter(const ScoreTable& table) : table_(table) {
        for (const std::string& row : table.rows) {
            rows_.push_back(shortened(printable(row)));
            label_width_ = std::max(label_width_, length_of(rows_.back()));
        }
        // "kd refined" stands on two lines: what is before the space, then what is after it.
        for (const std::string& column : table.columns) {
            const size_t space = std::min(column.find(' '), column.size());
            heads_[0].push_back(column.substr(0, space));
            heads_[1].push_back(column.substr(std::min(space + 1, column.size())));
            for (const auto& line : heads_) cell_width_ = std::max(cell_width_, length_of(line.back()) + 1);
        }
        // One more column keeps neighbouring metrics apart.
        metric_width_ = 1 + table.columns.size() * cell_width_;
    }

    std::string text() const {
        const size_t room = std::max<size_t>(1, (kTerminalColumns - label_width_) / metric_width_);
        std::string text;
        for (size_t first = 0; first < table_.metrics.size(); first += room) {
            text += block(first, std::min(first + room, table_.metrics.size())) + '\n';
        }
        return text;
    }

  private:
    std::string block(size_t first, size_t last) const {
        std::string titles(label_width_, ' ');
        for (size_t metric = first; metric < last; ++metric) {
            titles += ' ' + centred(table_.metrics[metric].metric, metric_width_ - 1);
        }
        std::string text = trimmed(titles);
        for (const auto& head : heads_) {
            const bool is_empty = std::ranges::all_of(head, &std::string::empty);
            if (!is_empty)
                text += line(
                    "", last - first, [&](size_t) -> const auto& { return head; });
        }
        for (size_t row = 0; row < rows_.size(); ++row) {
            text += line(
                rows_[row],
                last - first, [&](size_t i) -> const auto& { return table_.metrics[first + i].cells[row]; });
        }
        return text;
    }

    /// The cells of so many metrics behind a label.
    template <class CellsOf>
    std::string line(const std::string& label, size_t metrics, CellsOf&& cells_of) const {
        std::string line = padded(label, label_width_);
        for (size_t metric = 0; metric < metrics; ++metric) {
            line += ' ';
            for (const std::string& cell : cells_of(metric)) line += right(cell, cell_width_);
        }
        return trimmed(line);
    }

    const ScoreTable& table_;
    std::vector<std::string> rows_;
    std::array<std::vector<std::string>, 2> heads_;
    size_t label_width_ = 0, cell_width_ = kShortestCell, metric_width_ = 0;
};

std::string score_text(const Evaluation& evaluation) {
    if (evaluation.objects.empty()) return {};
    const std::string key = printable(column_key(evaluation));
    std::string text =
        scored_pixels(evaluation, Pixels::kAll) + '\n' + key + (key.empty() ? "\n" : "\n\n") +
        MetricPrinter(score_table(evaluation, Pixels::kAll)).text() +
        "Averages over the objects, of all frames and of the last tenth of those that show an object:\n\n" +
        MetricPrinter(summary_table(evaluation)).text();
    for (const auto& [title, views] : views_sections(evaluation))
        text += title + ":\n\n" + MetricPrinter(summary_table(views)).text();
    return text;
}

std::string light_text(const LightErrors& lights) {
    std::string text;
    for (const LightRow& row : light_rows(lights)) {
        text += fmt::format("  {} at ({}) m: {}", row.light, row.position, row.match);
        if (row.position_error) {
            text += fmt::format(", {} off\n    intensity off by {}; after division by the common factor by {}",
                                *row.position_error, *row.intensity_error, *row.after_factor);
        }
        text += '\n';
    }
    return text;
}

}  // namespace

std::string eval_text(const Evaluation& evaluation) {
    std::string text =
        fmt::format("{} against {}: {} frames of {} x {} (truth has {}, the run {})\n\n", printable(evaluation.run),
                    printable(evaluation.sequence), evaluation.frames.size(), evaluation.extent.width,
                    evaluation.extent.height, evaluation.truth_frames, evaluation.run_frames);
    text += score_text(evaluation);
    const std::vector<Finding> list = findings(evaluation);
    for (const Finding& finding : list) text += padded(finding.name, 16) + printable(finding.value) + '\n';
    if (evaluation.lights) text += light_text(*evaluation.lights);
    const std::vector<std::string> notes = absences(evaluation);
    if (!list.empty() && !notes.empty()) text += '\n';
    for (const std::string& note : notes) text += "Note: " + printable(note) + '\n';
    return text;
}

}  // namespace patina::eval
