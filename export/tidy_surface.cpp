#include "export/tidy_surface.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <span>
#include <utility>

#include "export/coarser_mesh.h"
#include "export/mesh_parts.h"
#include "export/same_positions.h"

namespace patina {

namespace {

using Triangle = std::array<uint32_t, 3>;

struct Box {
    glm::vec3 low{1e9f}, high{-1e9f};

    void add(glm::vec3 point) {
        low = glm::min(low, point);
        high = glm::max(high, point);
    }
};

/// Which vertices hang together.
class ConnectedVertices {
  public:
    /// Vertices of one position are one.
    ConnectedVertices(std::span<const glm::vec3> positions_m, std::span<const Triangle> triangles)
        : parent_(positions_m.size()) {
        std::iota(parent_.begin(), parent_.end(), 0u);
        const std::vector<uint32_t> first = first_of_position(positions_m);
        for (uint32_t i = 0; i < first.size(); ++i) join(i, first[i]);
        for (const Triangle& triangle : triangles) {
            join(triangle[0], triangle[1]);
            join(triangle[1], triangle[2]);
        }
    }

    /// The same for all vertices of a part.
    uint32_t part_of(uint32_t vertex) {
        while (parent_[vertex] != vertex) vertex = parent_[vertex] = parent_[parent_[vertex]];
        return vertex;
    }

  private:
    void join(uint32_t a, uint32_t b) {
        const auto [low, high] = std::minmax({part_of(a), part_of(b)});
        parent_[high] = low;
    }

    std::vector<uint32_t> parent_;
};

/// Where a piece ends at a plane, vertices lie exactly in it, and none beyond.
bool is_cut_off(const std::array<uint32_t, 6>& at_sides) {
    return std::ranges::any_of(at_sides, [](uint32_t vertices) { return vertices >= 2; });
}

/// The triangles of parts that are large enough, or may be, and of the largest one.
std::vector<Triangle> firm_triangles(const Mesh& mesh, const TidyOptions& options) {
    if (options.least_part_m <= 0 || mesh.triangles.empty()) return mesh.triangles;
    const size_t vertices = mesh.positions_m.size();
    ConnectedVertices connected(mesh.positions_m, mesh.triangles);
    std::vector<Box> boxes(vertices);
    std::vector<std::array<uint32_t, 6>> at_sides(vertices);
    Box whole;
    for (const glm::vec3& position : mesh.positions_m) whole.add(position);
    const double least_part_m =
        std::max(options.least_part_m, options.least_part_share * double{glm::distance(whole.low, whole.high)});
    for (uint32_t i = 0; i < vertices; ++i) {
        const uint32_t part = connected.part_of(i);
        const glm::vec3 position = mesh.positions_m[i];
        boxes[part].add(position);
        for (uint32_t axis = 0; axis < 3; ++axis) {
            const auto at = static_cast<glm::length_t>(axis);
            at_sides[part][axis] += position[at] == whole.low[at];
            at_sides[part][3 + axis] += position[at] == whole.high[at];
        }
    }
    std::vector<uint32_t> triangles(vertices);
    for (const Triangle& triangle : mesh.triangles) ++triangles[connected.part_of(triangle[0])];
    const auto largest = static_cast<uint32_t>(std::ranges::max_element(triangles) - triangles.begin());
    std::vector<Triangle> firm;
    for (const Triangle& triangle : mesh.triangles) {
        const uint32_t part = connected.part_of(triangle[0]);
        const Box& box = boxes[part];
        const bool large = double{glm::distance(box.low, box.high)} >= least_part_m;
        if (large || part == largest || (options.in_pieces && is_cut_off(at_sides[part]))) firm.push_back(triangle);
    }
    return firm;
}

/// The mesh of some triangles in which each segment has its own vertices: where two meet, collapsing takes the vertices
/// of both along their common border.
struct DividedMesh {
    Mesh mesh;
    std::vector<uint32_t> vertices;  ///< of the mesh it was made from
    std::vector<uint32_t> labels;    ///< by vertex; empty without
};

DividedMesh divided(const Mesh& mesh, std::span<const Triangle> triangles, const MeshReflectance& reflectance) {
    DividedMesh all;
    for (const MeshPart& part :
         parts_by_label(static_cast<uint32_t>(mesh.positions_m.size()), triangles, reflectance.labels)) {
        const auto first = static_cast<uint32_t>(all.vertices.size());
        all.vertices.insert(all.vertices.end(), part.vertices.begin(), part.vertices.end());
        if (!reflectance.labels.empty()) all.labels.resize(all.vertices.size(), part.label);
        for (const Triangle& t : part.triangles)
            all.mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
    }
    for (const uint32_t vertex : all.vertices) {
        all.mesh.positions_m.push_back(mesh.positions_m[vertex]);
        all.mesh.normals.push_back(mesh.normals[vertex]);
        all.mesh.colors.push_back(mesh.colors[vertex]);
    }
    return all;
}

/// A copy of an element for each of the vertices; nothing where there are no elements.
template <class Element>
void append_copies(std::vector<Element>& elements, std::span<const uint32_t> vertices) {
    if (elements.empty()) return;
    for (const uint32_t vertex : vertices) elements.push_back(elements[vertex]);
}

void close_holes_of(TidyPiece& piece, const TidyOptions& options) {
    const HoleFilling filling = close_holes(piece.mesh, {options.most_hole_m, options.in_pieces});
    piece.closed_holes = filling.holes;
    if (filling.holes == 0) return;
    const auto first = static_cast<uint32_t>(piece.mesh.positions_m.size());
    append_copies(piece.mesh.positions_m, filling.vertices);
    append_copies(piece.mesh.normals, filling.vertices);
    append_copies(piece.mesh.colors, filling.vertices);
    append_copies(piece.reflectance.kd, filling.vertices);
    append_copies(piece.reflectance.labels, filling.vertices);
    for (const Triangle& t : filling.triangles)
        piece.mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
    piece.filled.resize(first, 0);
    piece.filled.resize(piece.mesh.positions_m.size(), 1);
}

TidyPiece collapsed(const TidyPiece& whole, const Coarseness& coarseness) {
    const DividedMesh all = divided(whole.mesh, whole.mesh.triangles, whole.reflectance);
    const std::vector<float> of_mesh = shades_of(whole.mesh, whole.reflectance);
    std::vector<float> shades;
    for (const uint32_t vertex : all.vertices) shades.push_back(of_mesh[vertex]);
    CoarserMesh fewer = coarser(all.mesh, shades, coarseness);
    TidyPiece piece;
    piece.mesh = std::move(fewer.mesh);
    piece.reflectance.segments = whole.reflectance.segments;
    piece.collapsed_triangles = whole.mesh.triangles.size() - piece.mesh.triangles.size();
    if (!whole.filled.empty())
        for (const uint32_t vertex : fewer.vertices) piece.filled.push_back(whole.filled[all.vertices[vertex]]);
    if (whole.reflectance.kd.empty()) return piece;
    for (const uint32_t vertex : fewer.vertices) {
        piece.reflectance.kd.push_back(whole.reflectance.kd[all.vertices[vertex]]);
        piece.reflectance.labels.push_back(all.labels[vertex]);
    }
    return piece;
}

}  // namespace

void leave_out_stray_parts(TidyPiece& piece, const TidyOptions& options) {
    std::vector<Triangle> firm = firm_triangles(piece.mesh, options);
    piece.loose_triangles += piece.mesh.triangles.size() - firm.size();
    piece.mesh.triangles = std::move(firm);
}

TidyPiece tidied(const Mesh& mesh, const MeshReflectance& reflectance, const TidyOptions& options) {
    TidyPiece piece;
    piece.mesh = mesh;
    piece.reflectance = reflectance;
    leave_out_stray_parts(piece, options);
    close_holes_of(piece, options);
    if (options.error_m <= 0) return piece;
    TidyPiece fewer =
        collapsed(piece, {.error_m = options.error_m, .white_m = options.white_m, .locks_border = options.in_pieces});
    fewer.loose_triangles = piece.loose_triangles;
    fewer.closed_holes = piece.closed_holes;
    return fewer;
}

TidyPiece reduced(const TidyPiece& piece, double part, const TidyOptions& options, double most_error_m) {
    return collapsed(
        piece, {.part = part, .error_m = most_error_m, .white_m = options.white_m, .locks_border = options.in_pieces});
}

}  // namespace patina
