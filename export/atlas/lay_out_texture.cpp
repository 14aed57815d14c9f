#include "export/atlas/lay_out_texture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "export/atlas/find_charts.h"
#include "export/atlas/pack_boxes.h"
#include "export/mesh_parts.h"

namespace patina {
namespace {

constexpr uint32_t kUnused = UINT32_MAX;
constexpr double kCoarsestTexel_m = 0.1;  // what so many charts ask for that it does not suffice gets more pages
constexpr double kFinerPages = 1.03;      // texels grow by a little more than the missing area, for what packing wastes

glm::uvec2 box_of(const Chart& chart, double texel_m) {
    const auto texels = [&](float size_m) { return static_cast<uint32_t>(std::ceil(double{size_m} / texel_m)) + 1; };
    return glm::uvec2(texels(chart.size_m.x), texels(chart.size_m.y)) + 2 * kTextureGutter;
}

/// A segment's part of a piece, as a mesh of its own, in charts.
struct ChartedPart {
    MeshPart part;
    std::vector<Chart> charts;
};

std::vector<ChartedPart> charts_of(const TidyPiece& piece, double most_m) {
    std::vector<ChartedPart> charted;
    const auto vertices = static_cast<uint32_t>(piece.mesh.positions_m.size());
    for (MeshPart& part : parts_by_label(vertices, piece.mesh.triangles, piece.reflectance.labels)) {
        const Mesh alone{
            gathered(piece.mesh.positions_m, part), gathered(piece.mesh.normals, part), {}, part.triangles};
        std::vector<Chart> charts = find_charts(alone, most_m);
        charted.push_back({std::move(part), std::move(charts)});
    }
    return charted;
}

template <class Element>
void append(std::vector<Element>& to, const std::vector<Element>& from, uint32_t index) {
    if (!from.empty()) to.push_back(from[index]);
}

/// Gives each chart of a piece its own vertices.
class SurfaceBuilder {
  public:
    SurfaceBuilder(const TidyPiece& piece, double texel_m)
        : piece_(piece), texel_m_(static_cast<float>(texel_m)), numbers_(piece.mesh.positions_m.size(), kUnused) {
        surface.reflectance.segments = piece.reflectance.segments;
    }

    void add(const MeshPart& part, const Chart& chart, const PackedBoxes::Place& place) {
        used_.clear();
        const float side = side_of(part, chart);
        for (const uint32_t t : chart.triangles) {
            std::array<uint32_t, 3> triangle = part.triangles[t];
            for (uint32_t& vertex : triangle) vertex = number_of(part.vertices[vertex], part.label, chart, place, side);
            surface.mesh.triangles.push_back(triangle);
        }
        for (const uint32_t vertex : used_) numbers_[vertex] = kUnused;
    }

    TexturedSurface surface;

  private:
    /// Which way round its axes are, seen from where most of it faces.
    float side_of(const MeshPart& part, const Chart& chart) const {
        glm::vec3 facing(0);
        for (const uint32_t t : chart.triangles)
            for (const uint32_t vertex : part.triangles[t]) facing += piece_.mesh.normals[part.vertices[vertex]];
        return glm::dot(glm::cross(facing, chart.right), chart.down) > 0 ? -1.0f : 1.0f;
    }

    static glm::vec3 tangent_of(glm::vec3 right, glm::vec3 normal) {
        const glm::vec3 across =
            right - normal * (glm::dot(right, normal) / std::max(glm::dot(normal, normal), 1e-12f));
        return glm::dot(across, across) > 1e-6f ? glm::normalize(across) : right;
    }

    uint32_t number_of(uint32_t vertex, uint32_t label, const Chart& chart, const PackedBoxes::Place& place,
                       float side) {
        uint32_t& number = numbers_[vertex];
        if (number != kUnused) return number;
        number = static_cast<uint32_t>(surface.place_px.size());
        used_.push_back(vertex);
        const glm::vec3 position_m = piece_.mesh.positions_m[vertex];
        surface.mesh.positions_m.push_back(position_m);
        append(surface.mesh.normals, piece_.mesh.normals, vertex);
        surface.tangents.emplace_back(tangent_of(chart.right, piece_.mesh.normals[vertex]), side);
        append(surface.mesh.colors, piece_.mesh.colors, vertex);
        append(surface.filled, piece_.filled, vertex);
        append(surface.reflectance.kd, piece_.reflectance.kd, vertex);
        if (!piece_.reflectance.labels.empty()) surface.reflectance.labels.push_back(label);
        const glm::vec2 in_plane_m(glm::dot(position_m, chart.right), glm::dot(position_m, chart.down));
        surface.place_px.push_back(glm::vec2(place.at + kTextureGutter) + 0.5f + (in_plane_m - chart.low_m) / texel_m_);
        surface.pages.push_back(place.page);
        return number;
    }

    const TidyPiece& piece_;
    float texel_m_;
    std::vector<uint32_t> numbers_, used_;  // of vertices in the chart at hand
};

/// Sizes of all charts, one piece after the other.
std::vector<glm::uvec2> boxes_of(const std::vector<std::vector<ChartedPart>>& pieces, double texel_m) {
    std::vector<glm::uvec2> boxes;
    for (const std::vector<ChartedPart>& parts : pieces)
        for (const ChartedPart& part : parts)
            for (const Chart& chart : part.charts) boxes.push_back(box_of(chart, texel_m));
    return boxes;
}

/// A triangle must fit into a page, however it is turned.
double longest_edge_m(const std::vector<TidyPiece>& pieces) {
    float longest_m = 0;
    for (const TidyPiece& piece : pieces) {
        const std::vector<glm::vec3>& at_m = piece.mesh.positions_m;
        for (const auto& t : piece.mesh.triangles)
            for (size_t i = 0; i < 3; ++i)
                longest_m = std::max(longest_m, glm::distance(at_m[t[i]], at_m[t[(i + 1) % 3]]));
    }
    return double{longest_m};
}

}  // namespace

TextureLayout lay_out_texture(std::vector<TidyPiece> pieces, const TextureOptions& options) {
    TextureLayout layout;
    std::vector<std::vector<ChartedPart>> charted;
    const double side = options.page - 2.0 * kTextureGutter - 2;
    layout.texel_m = std::max(options.texel_m, 1.001 * longest_edge_m(pieces) / side);
    const double most_m = layout.texel_m * side;
    for (const TidyPiece& piece : pieces) charted.push_back(charts_of(piece, most_m));
    std::vector<glm::uvec2> boxes = boxes_of(charted, layout.texel_m);
    PackedBoxes packed = pack_boxes(boxes, options.page);
    while (packed.pages.size() > options.most_pages && layout.texel_m < kCoarsestTexel_m) {
        const double missing = static_cast<double>(packed.pages.size()) / options.most_pages;
        layout.texel_m *= kFinerPages * std::sqrt(std::max(missing, 1.0));
        boxes = boxes_of(charted, layout.texel_m);
        packed = pack_boxes(boxes, options.page);
    }
    layout.pages = packed.pages;
    size_t next = 0;
    for (size_t i = 0; i < pieces.size(); ++i) {
        SurfaceBuilder builder(pieces[i], layout.texel_m);
        for (const ChartedPart& of : charted[i]) {
            for (const Chart& chart : of.charts) {
                const PackedBoxes::Place& place = packed.places[next];
                builder.add(of.part, chart, place);
                layout.boxes.push_back({place.page, place.at, place.at + boxes[next], of.part.label});
                ++next;
            }
        }
        layout.pieces.push_back(std::move(builder.surface));
        pieces[i] = {};
        charted[i] = {};
    }
    return layout;
}

}  // namespace patina
