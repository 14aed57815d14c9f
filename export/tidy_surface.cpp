#include "export/tidy_surface.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <span>
#include <utility>

#include "export/coarser_mesh.h"
#include "export/mesh_parts.h"

namespace patina {

namespace {

using Triangle = std::array<uint32_t, 3>;

constexpr float kHeightOfWhite_m = 0.02f;

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
    ConnectedVertices(size_t vertices, std::span<const Triangle> triangles) : parent_(vertices) {
        std::iota(parent_.begin(), parent_.end(), 0u);
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
std::vector<Triangle> firm_triangles(const Mesh& mesh, double least_part_m) {
    if (least_part_m <= 0 || mesh.triangles.empty()) return mesh.triangles;
    const size_t vertices = mesh.positions_m.size();
    ConnectedVertices connected(vertices, mesh.triangles);
    std::vector<Box> boxes(vertices);
    std::vector<std::array<uint32_t, 6>> at_sides(vertices);
    Box whole;
    for (const glm::vec3& position : mesh.positions_m) whole.add(position);
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
        if (large || part == largest || is_cut_off(at_sides[part])) firm.push_back(triangle);
    }
    return firm;
}

void append(TidyPiece& piece, CoarserMesh&& part, const MeshPart& of, const MeshReflectance& reflectance) {
    const auto first = static_cast<uint32_t>(piece.mesh.positions_m.size());
    const auto add = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
    add(piece.mesh.positions_m, part.mesh.positions_m);
    add(piece.mesh.normals, part.mesh.normals);
    add(piece.mesh.colors, part.mesh.colors);
    for (const Triangle& t : part.mesh.triangles)
        piece.mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
    if (reflectance.kd.empty()) return;
    for (const uint32_t vertex : part.vertices) {
        piece.reflectance.kd.push_back(reflectance.kd[of.vertices[vertex]]);
        piece.reflectance.labels.push_back(of.label);
    }
}

/// Of the given triangles of a mesh.
TidyPiece by_segments(const Mesh& mesh, std::span<const Triangle> triangles, const MeshReflectance& reflectance,
                      const Coarseness& coarseness) {
    TidyPiece piece;
    piece.reflectance.segments = reflectance.segments;
    const std::vector<float> shades = shades_of(mesh, reflectance);
    for (const MeshPart& part :
         parts_by_label(static_cast<uint32_t>(mesh.positions_m.size()), triangles, reflectance.labels)) {
        const Mesh alone{gathered(mesh.positions_m, part), gathered(mesh.normals, part), gathered(mesh.colors, part),
                         part.triangles};
        append(piece, coarser(alone, gathered(shades, part), coarseness), part, reflectance);
    }
    piece.collapsed_triangles = triangles.size() - piece.mesh.triangles.size();
    return piece;
}

}  // namespace

TidyPiece tidied(const Mesh& mesh, const MeshReflectance& reflectance, const TidyOptions& options) {
    std::vector<Triangle> firm = firm_triangles(mesh, options.least_part_m);
    const uint64_t loose = mesh.triangles.size() - firm.size();
    TidyPiece piece;
    if (options.error_m > 0) {
        piece = by_segments(mesh, firm, reflectance, {.error_m = options.error_m, .white_m = kHeightOfWhite_m});
    } else {
        piece = {mesh, reflectance};
        piece.mesh.triangles = std::move(firm);
    }
    piece.loose_triangles = loose;
    return piece;
}

TidyPiece reduced(const Mesh& mesh, const MeshReflectance& reflectance, double part) {
    return by_segments(mesh, mesh.triangles, reflectance, {.part = part, .white_m = kHeightOfWhite_m});
}

}  // namespace patina
