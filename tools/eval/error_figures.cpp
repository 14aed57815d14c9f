#include "tools/eval/error_figures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <set>

#include <fmt/format.h>

#include "tools/eval/exr_planes.h"
#include "tools/eval/frame_channels.h"
#include "tools/eval/table.h"
#include "tools/report/drawing.h"
#include "tools/report/plot.h"

namespace patina::eval {
namespace {

namespace fs = std::filesystem;

constexpr std::array<uint32_t, 4> kPanelWidths = {384, 288, 192, 128};  ///< the first that is small enough is taken
constexpr double kQuantile = 0.99;                                      ///< single outliers do not eat the scale
constexpr uint32_t kStripes = 60;                                       ///< of hatching across a picture
constexpr SrgbPixel kHatch{150, 150, 150};

/// What a row of pictures shows.
struct RowKind {
    std::string title;
    QuantityChannels channels;
    bool is_color = true;
    const char* value_unit = "";
    const char* error_unit = "";
    double error_units = 1;  ///< error units in one value unit
};

std::vector<RowKind> row_kinds(const std::set<std::string>& run_groups) {
    std::vector<RowKind> kinds;
    for (const Quantity quantity : kQuantities) {
        kinds.push_back({title_of(quantity), channels_for(quantity), channels_of(quantity) == 3});
    }
    kinds.push_back({"depth", {"depth", "depth", false}, false, " m", " mm", 1000});
    std::erase_if(kinds, [&](const RowKind& kind) { return !run_groups.contains(kind.channels.run); });
    return kinds;
}

/// The upper ends of the scales; quantities that are compared with the same truth share them.
struct Tops {
    std::map<std::string, double> value, error;
};

struct FramePair {
    uint32_t index;
    ExrPlanes truth, run;
};

enum class PixelState : uint8_t { kNoTruth, kUnfilled, kFilled };

/// One quantity's planes in both files.
class Planes {
  public:
    Planes(const FramePair& frame, const RowKind& kind) : displayed_(kind.channels.displayed) {
        for (const auto& name : channel_names(kind.channels.truth)) truth_.push_back(&frame.truth.plane(name));
        for (const auto& name : channel_names(kind.channels.run)) run_.push_back(&frame.run.plane(name));
        const auto& truth_valid = frame.truth.plane("valid");
        const auto& run_valid = frame.run.plane("valid");
        state_.resize(truth_valid.size(), PixelState::kNoTruth);
        for (size_t i = 0; i < state_.size(); ++i) {
            if (!(truth_valid[i] > 0.5f)) continue;
            const bool finite =
                std::ranges::all_of(run_, [i](const auto* plane) { return std::isfinite((*plane)[i]); });
            state_[i] = run_valid[i] > 0.5f && finite ? PixelState::kFilled : PixelState::kUnfilled;
        }
    }

    size_t size() const { return state_.size(); }
    PixelState state(size_t i) const { return state_[i]; }
    glm::vec3 truth(size_t i) const { return value(truth_, i); }
    glm::vec3 run(size_t i) const { return value(run_, i); }
    double error(size_t i) const {
        const glm::vec3 difference = glm::abs(run(i) - truth(i));
        return (double{difference.r} + difference.g + difference.b) / 3;  // a scalar stands in all three
    }

  private:
    using PlaneList = std::vector<const std::vector<float>*>;

    glm::vec3 value(const PlaneList& planes, size_t i) const {
        const size_t last = planes.size() - 1;
        const glm::vec3 v{(*planes[0])[i], (*planes[std::min<size_t>(1, last)])[i], (*planes[last])[i]};
        return displayed_ ? glm::clamp(v, 0.0f, 1.0f) : v;
    }

    bool displayed_;
    PlaneList truth_, run_;
    std::vector<PixelState> state_;
};

double quantile_of(std::vector<double> values) {
    if (values.empty()) return 0;
    const auto at = values.begin() + static_cast<std::ptrdiff_t>(kQuantile * static_cast<double>(values.size() - 1));
    std::ranges::nth_element(values, at);
    return *at;
}

void raise(double& top, const Planes& planes, PixelState least, const std::function<double(size_t)>& value) {
    std::vector<double> values;
    for (size_t i = 0; i < planes.size(); ++i) {
        if (planes.state(i) >= least) values.push_back(value(i));
    }
    top = std::max(top, quantile_of(std::move(values)));
}

/// A round number not far above; 1 where there is nothing to show.
double rounded_up(double top) { return top > 0 ? nice_ticks({0, top}, 4).range().high : 1; }

/// The files of some frames, loaded one frame at a time.
class Frames {
  public:
    explicit Frames(const Evaluation& evaluation)
        : truth_(exr_frames(fs::path(evaluation.sequence) / "truth" / "frames")),
          run_(exr_frames(fs::path(evaluation.run) / "frames")) {
        const size_t count = evaluation.frames.size();
        for (const size_t i : {size_t{0}, count / 2, count - 1}) {
            if (i < count && (chosen_.empty() || chosen_.back() != evaluation.frames[i])) {
                chosen_.push_back(evaluation.frames[i]);
            }
        }
    }

    size_t size() const { return chosen_.size(); }
    FramePair load(size_t i) const {
        return {chosen_[i], ExrPlanes::read(truth_.at(chosen_[i])), ExrPlanes::read(run_.at(chosen_[i]))};
    }

  private:
    std::map<uint32_t, fs::path> truth_, run_;
    std::vector<uint32_t> chosen_;
};

Tops tops_of(const Frames& frames) {
    Tops tops;
    for (size_t i = 0; i < frames.size(); ++i) {
        const FramePair frame = frames.load(i);
        for (const RowKind& kind : row_kinds(groups_of(frame.run))) {
            const Planes planes(frame, kind);
            raise(tops.error[kind.channels.truth], planes, PixelState::kFilled,
                  [&](size_t pixel) { return planes.error(pixel); });
            if (kind.is_color) continue;
            raise(tops.value[kind.channels.truth], planes, PixelState::kUnfilled,
                  [&](size_t pixel) { return double{planes.truth(pixel).r}; });
        }
    }
    for (auto* map : {&tops.value, &tops.error}) {
        for (auto& [name, top] : *map) top = rounded_up(top);
    }
    return tops;
}

/// Diagonal stripes, about as wide in the shrunken picture whatever its extent was.
SrgbPixel hatch_pixel(size_t i, uint32_t width) {
    const size_t stripe = std::max<size_t>(2, width / (2 * kStripes));
    return (i % width + i / width) / stripe % 2 == 0 ? kHatch : kNoValue;
}

/// As large as the largest panel.
Drawing drawn(const Planes& planes, Extent2D extent, PixelState least, const std::function<SrgbPixel(size_t)>& pixel) {
    Drawing drawing(extent, kNoValue);
    for (size_t i = 0; i < planes.size(); ++i) {
        if (planes.state(i) >= least) {
            drawing.pixels()[i] = pixel(i);
        } else if (planes.state(i) == PixelState::kUnfilled) {
            drawing.pixels()[i] = hatch_pixel(i, extent.width);
        }
    }
    return scaled_to(drawing, fitted_extent(extent, kPanelWidths.front()));
}

ColorScale scale_of(ColorMap map, double top, const char* unit) {
    Drawing row({256, 1});
    for (uint32_t i = 0; i < 256; ++i) row.at(i, 0) = map_pixel(map, static_cast<float>(i) / 255);
    return {png_of(row), "0", fmt::format("{:g}{}", top, unit)};
}

/// A row before its pictures are files.
struct DrawnRow {
    ErrorRow row;
    Drawing truth, run, error;
};

DrawnRow draw_row(const FramePair& frame, const RowKind& kind, const Tops& tops) {
    const Planes planes(frame, kind);
    const Extent2D extent = frame.truth.extent();
    const double error_top = tops.error.at(kind.channels.truth);
    DrawnRow drawn_row;
    drawn_row.row.title = kind.title;
    drawn_row.row.errors = scale_of(ColorMap::kInferno, error_top * kind.error_units, kind.error_unit);
    std::function<SrgbPixel(glm::vec3)> value_pixel = color_pixel;
    if (!kind.is_color) {
        const double top = tops.value.at(kind.channels.truth);
        drawn_row.row.values = scale_of(ColorMap::kViridis, top, kind.value_unit);
        value_pixel = [top](glm::vec3 v) { return map_pixel(ColorMap::kViridis, v.r / static_cast<float>(top)); };
    }
    drawn_row.truth =
        drawn(planes, extent, PixelState::kUnfilled, [&](size_t i) { return value_pixel(planes.truth(i)); });
    drawn_row.run = drawn(planes, extent, PixelState::kFilled, [&](size_t i) { return value_pixel(planes.run(i)); });
    drawn_row.error = drawn(planes, extent, PixelState::kFilled, [&](size_t i) {
        return map_pixel(ColorMap::kInferno, static_cast<float>(planes.error(i) / error_top));
    });
    return drawn_row;
}

struct DrawnFigure {
    uint32_t frame;
    std::vector<DrawnRow> rows;
};

std::vector<DrawnFigure> draw_figures(const Frames& frames) {
    const Tops tops = tops_of(frames);
    std::vector<DrawnFigure> figures;
    for (size_t i = 0; i < frames.size(); ++i) {
        const FramePair frame = frames.load(i);
        DrawnFigure& figure = figures.emplace_back(DrawnFigure{frame.index, {}});
        for (const RowKind& kind : row_kinds(groups_of(frame.run))) figure.rows.push_back(draw_row(frame, kind, tops));
    }
    return figures;
}

std::vector<ErrorFigure> encoded(const std::vector<DrawnFigure>& drawn_figures, uint32_t panel_width) {
    const auto png = [&](const Drawing& drawing) {
        return png_of(scaled_to(drawing, fitted_extent(drawing.extent(), panel_width)));
    };
    std::vector<ErrorFigure> figures;
    for (const DrawnFigure& drawn_figure : drawn_figures) {
        ErrorFigure& figure = figures.emplace_back(ErrorFigure{drawn_figure.frame, {}});
        for (const DrawnRow& drawn_row : drawn_figure.rows) {
            ErrorRow& row = figure.rows.emplace_back(drawn_row.row);
            row.truth = png(drawn_row.truth);
            row.run = png(drawn_row.run);
            row.error = png(drawn_row.error);
        }
    }
    return figures;
}

size_t bytes_of(const std::vector<ErrorFigure>& figures) {
    size_t bytes = 0;
    for (const ErrorFigure& figure : figures) {
        for (const ErrorRow& row : figure.rows) bytes += row.truth.size() + row.run.size() + row.error.size();
    }
    return bytes;
}

}  // namespace

std::vector<ErrorFigure> error_figures(const Evaluation& evaluation) {
    const std::vector<DrawnFigure> drawn_figures = draw_figures(Frames(evaluation));
    std::vector<ErrorFigure> figures;
    for (const uint32_t width : kPanelWidths) {
        figures = encoded(drawn_figures, width);
        if (bytes_of(figures) <= kMostFigureBytes) break;
    }
    return figures;
}

std::string unfilled_sample() {
    Drawing sample({32, 16});
    for (size_t i = 0; i < sample.pixels().size(); ++i) sample.pixels()[i] = hatch_pixel(i, sample.extent().width);
    return png_of(sample);
}

std::string no_truth_sample() { return png_of(Drawing({32, 16}, kNoValue)); }

}  // namespace patina::eval
