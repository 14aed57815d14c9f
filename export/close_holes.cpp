#include "export/close_holes.h"

#include <algorithm>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <span>
#include <utility>

#include "export/same_positions.h"

namespace patina {

namespace {

using Triangle = std::array<uint32_t, 3>;
using Edge = std::pair<uint32_t, uint32_t>;
using Loop = std::vector<uint32_t>;  ///< vertices, as what closes it goes round

constexpr size_t kMostCorners = 512;      // the triangulation takes time with their third power
constexpr float kLeastAgreement = 0.25f;  // cosine between what closes a hole and the surface around it

/// Edges by their vertices' positions.
class Borders {
  public:
    Borders(const Mesh& mesh, bool in_pieces) : mesh_(mesh), first_(first_of_position(mesh.positions_m)) {
        list_edges();
        for (const glm::vec3& position : mesh.positions_m) {
            low_ = glm::min(low_, position);
            high_ = glm::max(high_, position);
        }
        for (const Triangle& t : mesh.triangles) {
            for (size_t i = 0; i < 3; ++i) {
                const auto [from, to] = edge_of(t, i);
                if (from == to || goes_round(to, from)) continue;
                next_.emplace(to, from);
                if (in_pieces && is_cut_off(from, to, t[(i + 2) % 3])) cut_off_.insert({to, from});
            }
        }
    }

    /// Each border edge is in one loop at most. A loop that passes a vertex twice is two.
    std::vector<Loop> loops() {
        std::vector<Loop> found;
        while (!next_.empty()) walk(next_.begin()->first, found);
        return found;
    }

    /// Of the mesh, or added since.
    bool has_edge(uint32_t a, uint32_t b) const {
        return goes_round(a, b) || goes_round(b, a) || added_.contains(std::minmax(a, b));
    }

    void add_edges(const Loop& loop, std::span<const Triangle> triangles) {
        for (const Triangle& t : triangles)
            for (size_t i = 0; i < 3; ++i) added_.insert(std::minmax(loop[t[i]], loop[t[(i + 1) % 3]]));
    }

    bool is_cut_off(const Loop& loop) const {
        for (size_t i = 0; i < loop.size(); ++i)
            if (cut_off_.contains({loop[i], loop[(i + 1) % loop.size()]})) return true;
        return false;
    }

  private:
    void list_edges() {
        begins_.assign(first_.size() + 1, 0);
        for (const Triangle& t : mesh_.triangles)
            for (const uint32_t vertex : t) ++begins_[first_[vertex]];
        std::exclusive_scan(begins_.begin(), begins_.end(), begins_.begin(), 0u);
        std::vector<uint32_t> next(begins_);
        ends_.resize(begins_.back());
        for (const Triangle& t : mesh_.triangles) {
            for (size_t i = 0; i < 3; ++i) {
                const auto [from, to] = edge_of(t, i);
                ends_[next[from]++] = to;
            }
        }
    }

    /// Whether a triangle of the mesh has this edge, as it goes round.
    bool goes_round(uint32_t from, uint32_t to) const {
        const std::span<const uint32_t> ends(ends_);
        const auto of_vertex = ends.subspan(begins_[from], begins_[from + 1] - begins_[from]);
        return std::ranges::find(of_vertex, to) != of_vertex.end();
    }

    Edge edge_of(const Triangle& t, size_t i) const { return {first_[t[i]], first_[t[(i + 1) % 3]]}; }

    /// An edge in a side of the mesh's box, whose triangle is not: the surface goes on beyond.
    bool is_cut_off(uint32_t from, uint32_t to, uint32_t third) const {
        const auto& at = mesh_.positions_m;
        for (glm::length_t axis = 0; axis < 3; ++axis) {
            for (const float side : {low_[axis], high_[axis]})
                if (at[from][axis] == side && at[to][axis] == side && at[third][axis] != side) return true;
        }
        return false;
    }

    void walk(uint32_t start, std::vector<Loop>& found) {
        Loop path{start};
        std::map<uint32_t, size_t> places{{start, 0}};
        for (auto step = next_.find(start); step != next_.end(); step = next_.find(path.back())) {
            const uint32_t to = step->second;
            next_.erase(step);
            const auto [place, is_new] = places.emplace(to, path.size());
            if (is_new) {
                path.push_back(to);
                continue;
            }
            const auto begin = path.begin() + static_cast<std::ptrdiff_t>(place->second);
            found.emplace_back(begin, path.end());
            for (auto it = begin + 1; it != path.end(); ++it) places.erase(*it);
            path.erase(begin + 1, path.end());
        }
    }

    const Mesh& mesh_;
    std::vector<uint32_t> first_;
    std::vector<uint32_t> begins_, ends_;  ///< by vertex, where its edges begin, and to which vertices they go
    std::set<Edge> added_, cut_off_;
    std::multimap<uint32_t, uint32_t> next_;  ///< border edges that are in no loop yet
    glm::vec3 low_{1e9f}, high_{-1e9f};
};

constexpr double kLeastWidth = 1e-4;  // of a triangle that covers something, over its length

bool is_hole(const Mesh& mesh, const Loop& loop, double most_m) {
    if (loop.size() < 3 || loop.size() > kMostCorners) return false;
    glm::vec3 low(1e9f), high(-1e9f), area(0), around(0);
    const glm::vec3 origin = mesh.positions_m[loop[0]];
    for (size_t i = 0; i < loop.size(); ++i) {
        const glm::vec3 here = mesh.positions_m[loop[i]], there = mesh.positions_m[loop[(i + 1) % loop.size()]];
        low = glm::min(low, here);
        high = glm::max(high, here);
        area += glm::cross(here - origin, there - origin);
        around += mesh.normals[loop[i]];
    }
    const float lengths = glm::length(area) * glm::length(around);
    return double{glm::distance(low, high)} <= most_m && glm::dot(area, around) >= kLeastAgreement * lengths &&
           lengths > 0;
}

/// Of a polygon's corners, the triangles with the least area whose inner edges are allowed; empty where there are none.
class LeastArea {
  public:
    template <class IsAllowed>
    LeastArea(std::span<const glm::vec3> corners, const IsAllowed& is_allowed) : count_(corners.size()) {
        cost_.assign(count_ * count_, 0);
        split_.assign(count_ * count_, 0);
        for (size_t length = 2; length < count_; ++length) {
            for (size_t i = 0; i + length < count_; ++i) {
                const size_t j = i + length;
                double least = std::numeric_limits<double>::infinity();
                const bool is_edge = length == count_ - 1;  // of the polygon itself
                const bool allowed = is_edge || is_allowed(i, j);
                for (size_t k = i + 1; k < j && allowed; ++k) {
                    const double cost =
                        cost_[i * count_ + k] + cost_[k * count_ + j] + cost_of(corners[i], corners[k], corners[j]);
                    if (cost >= least) continue;
                    least = cost;
                    split_[i * count_ + j] = k;
                }
                cost_[i * count_ + j] = least;
            }
        }
    }

    /// Twice the area. One that is next to none costs what a wide one would, so that it is taken where nothing else is
    /// left.
    static double cost_of(glm::vec3 a, glm::vec3 b, glm::vec3 c) {
        const double area = double{glm::length(glm::cross(b - a, c - a))};
        const double longest2 =
            double{std::max({glm::dot(b - a, b - a), glm::dot(c - b, c - b), glm::dot(a - c, a - c)})};
        return area > kLeastWidth * longest2 ? area : longest2;
    }

    std::vector<Triangle> triangles() const {
        std::vector<Triangle> all;
        if (cost_[count_ - 1] < std::numeric_limits<double>::infinity()) collect(0, count_ - 1, all);
        return all;
    }

  private:
    void collect(size_t i, size_t j, std::vector<Triangle>& all) const {
        if (j < i + 2) return;
        const size_t k = split_[i * count_ + j];
        all.push_back({static_cast<uint32_t>(i), static_cast<uint32_t>(k), static_cast<uint32_t>(j)});
        collect(i, k, all);
        collect(k, j, all);
    }

    size_t count_;
    std::vector<double> cost_;
    std::vector<size_t> split_;
};

std::vector<Triangle> closing(const Mesh& mesh, const Borders& borders, const Loop& loop) {
    std::vector<glm::vec3> corners;
    for (const uint32_t vertex : loop) corners.push_back(mesh.positions_m[vertex]);
    return LeastArea(corners, [&](size_t i, size_t j) { return !borders.has_edge(loop[i], loop[j]); }).triangles();
}

}  // namespace

HoleFilling close_holes(const Mesh& mesh, const HoleOptions& options) {
    HoleFilling filling;
    if (options.most_m <= 0) return filling;
    Borders borders(mesh, options.in_pieces);
    for (const Loop& loop : borders.loops()) {
        if (!is_hole(mesh, loop, options.most_m) || borders.is_cut_off(loop)) continue;
        const std::vector<Triangle> triangles = closing(mesh, borders, loop);
        if (triangles.empty()) continue;
        borders.add_edges(loop, triangles);
        const auto first = static_cast<uint32_t>(filling.vertices.size());
        filling.vertices.insert(filling.vertices.end(), loop.begin(), loop.end());
        for (const Triangle& t : triangles) filling.triangles.push_back({first + t[0], first + t[1], first + t[2]});
        ++filling.holes;
    }
    return filling;
}

}  // namespace patina
