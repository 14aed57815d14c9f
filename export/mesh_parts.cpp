#include "export/mesh_parts.h"

#include <map>
#include <numeric>
#include <utility>

namespace patina {
namespace {

using Triangle = std::array<uint32_t, 3>;

/// Numbers the vertices in the order of first use; `number` is scratch, one entry per vertex, all kUnused.
constexpr uint32_t kUnused = UINT32_MAX;
void number_vertices(MeshPart& part, std::vector<uint32_t>& number) {
    for (Triangle& triangle : part.triangles) {
        for (uint32_t& vertex : triangle) {
            if (number[vertex] == kUnused) {
                number[vertex] = static_cast<uint32_t>(part.vertices.size());
                part.vertices.push_back(vertex);
            }
            vertex = number[vertex];
        }
    }
    for (const uint32_t vertex : part.vertices) number[vertex] = kUnused;
}

}  // namespace

uint32_t label_of(const Triangle& triangle, std::span<const uint32_t> labels) {
    const uint32_t a = labels[triangle[0]], b = labels[triangle[1]], c = labels[triangle[2]];
    return b == c ? b : a;
}

std::vector<MeshPart> parts_by_label(uint32_t vertex_count, std::span<const Triangle> triangles,
                                     std::span<const uint32_t> labels) {
    if (labels.empty()) {
        MeshPart all{0, std::vector<uint32_t>(vertex_count), {triangles.begin(), triangles.end()}};
        std::iota(all.vertices.begin(), all.vertices.end(), 0u);
        return {std::move(all)};
    }
    std::map<uint32_t, MeshPart> by_label;
    for (const Triangle& triangle : triangles) {
        const uint32_t label = label_of(triangle, labels);
        MeshPart& part = by_label[label];
        part.label = label;
        part.triangles.push_back(triangle);
    }
    std::vector<MeshPart> parts;
    std::vector<uint32_t> number(vertex_count, kUnused);
    for (auto& [label, part] : by_label) {
        number_vertices(part, number);
        parts.push_back(std::move(part));
    }
    return parts;
}

}  // namespace patina
