#include "tests/reference/segmentation/color_split.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace patina::reference {

namespace {

constexpr double kBlack = 0.006;  // sum of the channels

double sum_of(glm::dvec3 color) { return color.r + color.g + color.b; }
glm::dvec2 chromaticity(glm::dvec3 color) { return glm::dvec2(color.r, color.g) / sum_of(color); }

struct Placed {
    double along;
    glm::ivec3 voxel;
};

double mean(std::span<const Placed> part) {
    double sum = 0;
    for (const Placed& p : part) sum += p.along;
    return sum / static_cast<double>(part.size());
}

/// The direction of the greatest variance.
glm::dvec2 principal_axis(const std::vector<glm::dvec2>& points) {
    glm::dvec2 middle(0);
    for (const glm::dvec2& p : points) middle += p / static_cast<double>(points.size());
    double xx = 0, xy = 0, yy = 0;
    for (const glm::dvec2& p : points) {
        const glm::dvec2 d = p - middle;
        xx += d.x * d.x;
        xy += d.x * d.y;
        yy += d.y * d.y;
    }
    const double angle = 0.5 * std::atan2(2 * xy, xx - yy);
    return {std::cos(angle), std::sin(angle)};
}

/// Share of points whose nearest other point lies on the other side, over that of points strewn at random.
double mixture(std::span<const Placed> placed, size_t below) {
    size_t crossing = 0;
    for (size_t i = 0; i < placed.size(); ++i) {
        long same = std::numeric_limits<long>::max(), other = same;
        for (size_t j = 0; j < placed.size(); ++j) {
            if (i == j) continue;
            const glm::dvec3 off(placed[i].voxel - placed[j].voxel);
            long& nearest = (i < below) == (j < below) ? same : other;
            nearest = std::min(nearest, std::lround(glm::dot(off, off)));
        }
        crossing += other < same ? 1 : 0;
    }
    const double n = static_cast<double>(placed.size()), share = static_cast<double>(below) / n;
    return static_cast<double>(crossing) / n / (2 * share * (1 - share));
}

}  // namespace

std::optional<ColorSplit> best_color_split(const std::vector<ColoredVoxel>& voxels) {
    std::vector<glm::dvec2> points;
    std::vector<Placed> placed;
    for (const ColoredVoxel& v : voxels) {
        if (sum_of(v.color) >= kBlack) points.push_back(chromaticity(v.color));
    }
    if (points.size() < 2) return std::nullopt;
    ColorSplit split;
    split.axis = principal_axis(points);
    for (const ColoredVoxel& v : voxels) {
        if (sum_of(v.color) >= kBlack) placed.push_back({glm::dot(split.axis, chromaticity(v.color)), v.voxel});
    }
    std::ranges::stable_sort(placed, {}, &Placed::along);
    size_t best = 0;
    double best_between = 0;
    for (size_t below = 1; below < placed.size(); ++below) {
        if (placed[below - 1].along == placed[below].along) continue;
        const std::span all(placed);
        const double apart = mean(all.subspan(below)) - mean(all.first(below));
        const double between = static_cast<double>(below) * static_cast<double>(placed.size() - below) * apart * apart;
        if (between > best_between) {
            best_between = between;
            best = below;
        }
    }
    if (best == 0) return std::nullopt;
    const std::span<const Placed> low = std::span(placed).first(best), high = std::span(placed).subspan(best);
    split.apart = mean(high) - mean(low);
    split.threshold = (mean(high) + mean(low)) / 2;
    const double first = mean(low) + split.apart / 4, last = mean(high) - split.apart / 4;
    const auto between =
        std::ranges::count_if(placed, [&](const Placed& p) { return p.along > first && p.along < last; });
    split.between = static_cast<double>(between) / static_cast<double>(placed.size());
    split.mixed = mixture(placed, best);
    const auto beyond =
        static_cast<size_t>(std::ranges::count_if(placed, [&](const Placed& p) { return p.along > split.threshold; }));
    split.fewer = std::min(beyond, placed.size() - beyond);
    if (beyond > split.fewer) {
        split.axis = -split.axis;
        split.threshold = -split.threshold;
    }
    return split;
}

bool is_of_fewer(const ColorSplit& split, glm::dvec3 color) {
    return sum_of(color) >= kBlack && glm::dot(split.axis, chromaticity(color)) > split.threshold;
}

}  // namespace patina::reference
