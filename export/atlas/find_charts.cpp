#include "export/atlas/find_charts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

namespace patina {
namespace {

using Triangle = std::array<uint32_t, 3>;

constexpr uint32_t kNone = UINT32_MAX;
constexpr float kLeastFacing = 0.5f;    // cosine of 60 degrees: of the surface's normals,
constexpr float kLeastUnfolded = 0.1f;  // and of the triangles themselves, which scatter more
constexpr float kCell_m = 0.01f;        // edge of the cells by which overlaps are found
constexpr float kSheet_m = 0.04f;       // what is higher than this over the same cell is another sheet
constexpr int kMostCells = 2000;        // along a side; cells of a larger chart are larger
constexpr int kAngles = 18;             // that are tried for the box, over a quarter turn

/// The three triangles beside each triangle, across its edges; kNone at borders. Where more than two share an edge, the
/// first two are neighbours.
std::vector<Triangle> neighbours_of(const std::vector<Triangle>& triangles) {
    struct Edge {
        uint64_t vertices;
        uint32_t triangle, side;
    };
    std::vector<Edge> edges;
    edges.reserve(3 * triangles.size());
    for (uint32_t t = 0; t < triangles.size(); ++t) {
        for (uint32_t side = 0; side < 3; ++side) {
            const uint64_t a = triangles[t][side], b = triangles[t][(side + 1) % 3];
            edges.push_back({std::min(a, b) << 32 | std::max(a, b), t, side});
        }
    }
    std::ranges::stable_sort(edges, {}, &Edge::vertices);
    std::vector<Triangle> beside(triangles.size(), {kNone, kNone, kNone});
    for (size_t i = 0; i + 1 < edges.size(); ++i) {
        if (edges[i].vertices != edges[i + 1].vertices) continue;
        beside[edges[i].triangle][edges[i].side] = edges[i + 1].triangle;
        beside[edges[i + 1].triangle][edges[i + 1].side] = edges[i].triangle;
        ++i;
    }
    return beside;
}

/// A plane by its axes.
struct Plane {
    explicit Plane(glm::vec3 facing) : across(glm::normalize(facing)) {
        const glm::vec3 aside = std::abs(across.y) < 0.9f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0);
        right = glm::normalize(glm::cross(aside, across));
        down = glm::cross(right, across);  // seen from outside, right and down are as in a picture
    }

    glm::vec2 at(glm::vec3 position) const { return {glm::dot(position, right), glm::dot(position, down)}; }

    glm::vec3 across, right, down;
};

struct Box {
    glm::vec2 low{1e30f}, high{-1e30f};

    void add(glm::vec2 point) {
        low = glm::min(low, point);
        high = glm::max(high, point);
    }
    glm::vec2 size() const { return high - low; }
};

/// Which cells of a plane a chart covers, and how high it lies over them.
class Sheet {
  public:
    explicit Sheet(const Box& box) : low_(box.low) {
        const glm::vec2 size = box.size();
        cell_m_ = std::max(kCell_m, std::max(size.x, size.y) / static_cast<float>(kMostCells));
        width_ = static_cast<int>(size.x / cell_m_) + 1;
        height_ = static_cast<int>(size.y / cell_m_) + 1;
        spans_.resize(static_cast<size_t>(width_) * static_cast<size_t>(height_));
    }

    /// Adds a triangle, unless it lies over or under the sheet, or outside the box.
    bool add(const std::array<glm::vec2, 3>& corners, const std::array<float, 3>& heights) {
        cells_.clear();
        if (!collect(corners, heights)) return false;
        for (const auto& [cell, height] : cells_) {
            const Span& span = spans_[cell];
            if (span.low <= span.high && (height < span.low - kSheet_m || height > span.high + kSheet_m)) return false;
        }
        for (const auto& [cell, height] : cells_) {
            spans_[cell].low = std::min(spans_[cell].low, height);
            spans_[cell].high = std::max(spans_[cell].high, height);
        }
        return true;
    }

  private:
    struct Span {
        float low = 1e30f, high = -1e30f;
    };

    /// The cells whose centres are within the triangle, and the one of its own centre.
    bool collect(const std::array<glm::vec2, 3>& corners, const std::array<float, 3>& heights) {
        const auto cell_of = [&](glm::vec2 point) { return glm::ivec2(glm::floor((point - low_) / cell_m_)); };
        const glm::ivec2 middle = cell_of((corners[0] + corners[1] + corners[2]) / 3.0f);
        if (!push(middle, (heights[0] + heights[1] + heights[2]) / 3)) return false;
        Box box;
        for (const glm::vec2 corner : corners) box.add(corner);
        const glm::ivec2 first = glm::max(cell_of(box.low), 0), last = cell_of(box.high);
        const glm::vec2 a = corners[1] - corners[0], b = corners[2] - corners[0];
        const float area = a.x * b.y - a.y * b.x;
        if (area == 0) return true;
        for (int y = first.y; y <= std::min(last.y, height_ - 1); ++y) {
            for (int x = first.x; x <= std::min(last.x, width_ - 1); ++x) {
                const glm::vec2 to = low_ + (glm::vec2(x, y) + 0.5f) * cell_m_ - corners[0];
                const float s = (to.x * b.y - to.y * b.x) / area, t = (a.x * to.y - a.y * to.x) / area;
                if (s < 0 || t < 0 || s + t > 1) continue;
                push({x, y}, heights[0] + s * (heights[1] - heights[0]) + t * (heights[2] - heights[0]));
            }
        }
        return true;
    }

    bool push(glm::ivec2 cell, float height) {
        if (cell.x < 0 || cell.y < 0 || cell.x >= width_ || cell.y >= height_) return false;
        cells_.emplace_back(static_cast<size_t>(cell.y) * static_cast<size_t>(width_) + static_cast<size_t>(cell.x),
                            height);
        return true;
    }

    glm::vec2 low_;
    float cell_m_ = 0;
    int width_ = 0, height_ = 0;
    std::vector<Span> spans_;
    std::vector<std::pair<size_t, float>> cells_;  // of the triangle at hand
};

class ChartFinder {
  public:
    ChartFinder(const Mesh& mesh, double most_m)
        : mesh_(mesh),
          most_m_(static_cast<float>(most_m)),
          beside_(neighbours_of(mesh.triangles)),
          taken_(mesh.triangles.size()),
          seen_(mesh.triangles.size()) {
        for (const Triangle& t : mesh.triangles) {
            const glm::vec3 twice = glm::cross(mesh.positions_m[t[1]] - mesh.positions_m[t[0]],
                                               mesh.positions_m[t[2]] - mesh.positions_m[t[0]]);
            const float area = glm::length(twice);
            areas_.push_back(area);
            flat_.push_back(area > 0 ? twice / area : glm::vec3(0));
            const glm::vec3 mean = mesh.normals[t[0]] + mesh.normals[t[1]] + mesh.normals[t[2]];
            const float length = glm::length(mean);
            smooth_.push_back(length > 1e-6f ? mean / length : flat_.back());
        }
    }

    std::vector<Chart> find() {
        std::vector<uint32_t> order(mesh_.triangles.size());
        std::iota(order.begin(), order.end(), 0u);
        std::ranges::stable_sort(order, std::greater{}, [&](uint32_t t) { return areas_[t]; });
        std::vector<Chart> charts;
        for (const uint32_t seed : order) {
            if (taken_[seed] || areas_[seed] == 0) continue;
            charts.push_back(chart_of(seed));
        }
        return charts;
    }

  private:
    Chart chart_of(uint32_t seed) {
        const glm::vec3 first = flat_[seed];
        glm::vec3 mean(0);
        Box reach;
        const Plane rough(first);
        grow(seed, rough, [&](uint32_t t, const auto& corners) {
            mean += areas_[t] * smooth_[t];
            for (const glm::vec2 corner : corners) reach.add(corner);
            return fits(reach);
        });
        if (last_grown_.empty()) last_grown_.push_back(seed);  // it is larger than most_m itself
        const bool turned = glm::length(mean) > 0 && glm::dot(glm::normalize(mean), first) > kLeastUnfolded;
        const Plane plane(turned ? mean : first);
        Box wanted = box_of(last_grown_, plane);
        Sheet sheet(wanted);
        Box box;
        Chart chart;
        grow(seed, plane, [&](uint32_t t, const auto& corners) {
            Box larger = box;
            for (const glm::vec2 corner : corners) larger.add(corner);
            if (!fits(larger)) return false;
            std::array<float, 3> heights;
            for (size_t i = 0; i < 3; ++i)
                heights[i] = glm::dot(mesh_.positions_m[mesh_.triangles[t][i]], plane.across);
            if (!sheet.add(corners, heights)) return false;
            box = larger;
            chart.triangles.push_back(t);
            return true;
        });
        if (chart.triangles.empty()) chart.triangles.push_back(seed);
        for (const uint32_t t : chart.triangles) taken_[t] = 1;
        place(chart, plane);
        return chart;
    }

    bool fits(const Box& box) const { return box.size().x <= most_m_ && box.size().y <= most_m_; }

    /// Offers the seed and what hangs together with it, breadth first, to `take`, which says whether it goes on there.
    template <class Take>
    void grow(uint32_t seed, const Plane& plane, const Take& take) {
        last_grown_.assign(1, seed);
        ++turn_;
        seen_[seed] = turn_;
        size_t grown = 0;
        for (size_t next = 0; next < last_grown_.size(); ++next) {
            const uint32_t t = last_grown_[next];
            std::array<glm::vec2, 3> corners;
            for (size_t i = 0; i < 3; ++i) corners[i] = plane.at(mesh_.positions_m[mesh_.triangles[t][i]]);
            if (!take(t, corners)) continue;
            last_grown_[grown++] = t;
            for (const uint32_t beside : beside_[t]) {
                if (beside == kNone || taken_[beside] || seen_[beside] == turn_ || !faces(beside, plane)) continue;
                seen_[beside] = turn_;
                last_grown_.push_back(beside);
            }
        }
        last_grown_.resize(grown);
    }

    bool faces(uint32_t t, const Plane& plane) const {
        return glm::dot(smooth_[t], plane.across) >= kLeastFacing && glm::dot(flat_[t], plane.across) >= kLeastUnfolded;
    }

    Box box_of(const std::vector<uint32_t>& triangles, const Plane& plane) const {
        Box box;
        for (const uint32_t t : triangles)
            for (const uint32_t vertex : mesh_.triangles[t]) box.add(plane.at(mesh_.positions_m[vertex]));
        return box;
    }

    /// Turns the plane's axes to the box of least area.
    void place(Chart& chart, const Plane& plane) const {
        float least = 1e30f;
        for (int i = 0; i < kAngles; ++i) {
            const float angle = static_cast<float>(i) / kAngles * std::numbers::pi_v<float> / 2;
            Plane turned = plane;
            turned.right = std::cos(angle) * plane.right + std::sin(angle) * plane.down;
            turned.down = std::cos(angle) * plane.down - std::sin(angle) * plane.right;
            const Box box = box_of(chart.triangles, turned);
            const float area = box.size().x * box.size().y;
            if (area >= least || (i > 0 && !fits(box))) continue;
            least = area;
            chart.right = turned.right;
            chart.down = turned.down;
            chart.low_m = box.low;
            chart.size_m = box.size();
        }
    }

    const Mesh& mesh_;
    float most_m_;
    std::vector<Triangle> beside_;
    std::vector<uint8_t> taken_;
    std::vector<uint32_t> seen_;  // the turn in which a triangle was offered
    uint32_t turn_ = 0;
    std::vector<uint32_t> last_grown_;
    std::vector<float> areas_;
    std::vector<glm::vec3> flat_, smooth_;  // normals: of the triangles, and of the surface there
};

}  // namespace

std::vector<Chart> find_charts(const Mesh& mesh, double most_m) { return ChartFinder(mesh, most_m).find(); }

}  // namespace patina
