#include "export/atlas/find_seams.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include "export/same_positions.h"

namespace patina {
namespace {

constexpr uint32_t kNoBox = UINT32_MAX;

/// An edge of a triangle, by vertices of all pieces together.
struct Edge {
    uint64_t ends;  ///< by position; the lesser one is in the upper half
    uint32_t from, to;
};

/// Which box each texel of the pages lies in.
std::vector<Image<uint32_t>> boxes_by_texel(const TextureLayout& layout) {
    std::vector<Image<uint32_t>> numbers;
    for (const Extent2D page : layout.pages) numbers.emplace_back(page, kNoBox);
    for (uint32_t i = 0; i < layout.boxes.size(); ++i) {
        const TextureBox& box = layout.boxes[i];
        for (uint32_t y = box.low.y; y < box.high.y; ++y)
            for (uint32_t x = box.low.x; x < box.high.x; ++x) numbers[box.page].at(x, y) = i;
    }
    return numbers;
}

/// The vertices of all pieces, and the edges between them, those that meet one after the other.
struct Outline {
    std::vector<glm::vec3> positions_m;
    std::vector<glm::vec2> place_px;
    std::vector<uint32_t> pages;
    std::vector<Edge> edges;
};

Outline outline_of(const TextureLayout& layout) {
    Outline all;
    for (const TexturedSurface& piece : layout.pieces) {
        all.positions_m.insert(all.positions_m.end(), piece.mesh.positions_m.begin(), piece.mesh.positions_m.end());
        all.place_px.insert(all.place_px.end(), piece.place_px.begin(), piece.place_px.end());
        all.pages.insert(all.pages.end(), piece.pages.begin(), piece.pages.end());
    }
    const std::vector<uint32_t> same = first_of_position(all.positions_m);
    uint32_t first = 0;
    for (const TexturedSurface& piece : layout.pieces) {
        for (const auto& triangle : piece.mesh.triangles) {
            for (size_t i = 0; i < 3; ++i) {
                uint32_t from = first + triangle[i], to = first + triangle[(i + 1) % 3];
                if (same[from] > same[to]) std::swap(from, to);
                all.edges.push_back({uint64_t{same[from]} << 32 | same[to], from, to});
            }
        }
        first += static_cast<uint32_t>(piece.mesh.positions_m.size());
    }
    std::ranges::sort(all.edges, {}, [](const Edge& edge) { return std::tuple(edge.ends, edge.from, edge.to); });
    return all;
}

}  // namespace

std::vector<Seam> find_seams(const TextureLayout& layout) {
    const Outline all = outline_of(layout);
    const std::vector<Image<uint32_t>> boxes = boxes_by_texel(layout);
    std::vector<Seam> seams;
    for (size_t i = 0; i < all.edges.size();) {
        Seam seam;
        const uint64_t ends = all.edges[i].ends;
        for (size_t before = i; i < all.edges.size() && all.edges[i].ends == ends; ++i) {
            const Edge &edge = all.edges[i], &last = all.edges[before];
            const bool within_chart = i > before && edge.from == last.from && edge.to == last.to;
            before = i;
            if (within_chart) continue;
            const uint32_t page = all.pages[edge.from];
            const glm::uvec2 texel(all.place_px[edge.from]);
            const uint32_t box = boxes[page].at(texel.x, texel.y);
            if (box != kNoBox) seam.sides.push_back({box, page, all.place_px[edge.from], all.place_px[edge.to]});
        }
        if (seam.sides.size() > 1) seams.push_back(std::move(seam));
    }
    return seams;
}

}  // namespace patina
