#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace patina {

/// The triangles of one segment with the vertices they use.
struct MeshPart {
    uint32_t label = 0;
    std::vector<uint32_t> vertices;                  ///< of the whole mesh
    std::vector<std::array<uint32_t, 3>> triangles;  ///< of the numbers within `vertices`
};

/// A part's vertices out of an array of the whole mesh.
template <class Element>
std::vector<Element> gathered(const std::vector<Element>& all, const MeshPart& part) {
    std::vector<Element> elements;
    elements.reserve(part.vertices.size());
    for (const uint32_t vertex : part.vertices) elements.push_back(all[vertex]);
    return elements;
}

/// The segment of a triangle: the label (by vertex) that two of its vertices agree on, else that of its first one.
uint32_t label_of(const std::array<uint32_t, 3>& triangle, std::span<const uint32_t> labels);

/// Divides triangles by their segment, label_of(), in ascending order of labels. Where segments meet, each has its own
/// copy of the vertices between them. Empty `labels` (by vertex): one part of all `vertex_count` vertices, label 0.
std::vector<MeshPart> parts_by_label(uint32_t vertex_count, std::span<const std::array<uint32_t, 3>> triangles,
                                     std::span<const uint32_t> labels);

}  // namespace patina
