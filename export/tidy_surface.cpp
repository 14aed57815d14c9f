#include "export/tidy_surface.h"

#include <algorithm>
#include <array>
#include <span>
#include <utility>

#include "export/coarser_mesh.h"
#include "export/connected_vertices.h"
#include "export/cut_off.h"
#include "export/merge_patches.h"
#include "export/mesh_parts.h"

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

/// The triangles of parts that are large enough, or may be, and of the largest one.
std::vector<Triangle> firm_triangles(const Mesh& mesh, const TidyOptions& options) {
    if (options.least_part_m <= 0 || mesh.triangles.empty()) return mesh.triangles;
    const size_t vertices = mesh.positions_m.size();
    ConnectedVertices connected(mesh.positions_m, mesh.triangles);
    std::vector<uint32_t> part(vertices);
    std::vector<Box> boxes(vertices);
    Box whole;
    for (uint32_t i = 0; i < vertices; ++i) {
        part[i] = connected.part_of(i);
        boxes[part[i]].add(mesh.positions_m[i]);
        whole.add(mesh.positions_m[i]);
    }
    const std::vector<bool> cut_off = cut_off_parts(mesh.positions_m, part);
    const double least_part_m =
        std::max(options.least_part_m, options.least_part_share * double{glm::distance(whole.low, whole.high)});
    std::vector<uint32_t> triangles(vertices);
    for (const Triangle& triangle : mesh.triangles) ++triangles[part[triangle[0]]];
    const auto largest = static_cast<uint32_t>(std::ranges::max_element(triangles) - triangles.begin());
    std::vector<Triangle> firm;
    for (const Triangle& triangle : mesh.triangles) {
        const uint32_t of = part[triangle[0]];
        const bool large = double{glm::distance(boxes[of].low, boxes[of].high)} >= least_part_m;
        if (large || of == largest || (options.in_pieces && cut_off[of])) firm.push_back(triangle);
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
    piece.reflectance.labels = merged_patches(piece.mesh, std::move(piece.reflectance.labels),
                                              options.least_patch_vertices, options.in_pieces);
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
