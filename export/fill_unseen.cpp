#include "export/fill_unseen.h"

#include <algorithm>
#include <span>
#include <vector>

namespace patina {

namespace {

/// The vertices beside each vertex, more than once where several triangles have both.
class Neighbours {
  public:
    explicit Neighbours(const Mesh& mesh) : first_(mesh.positions_m.size() + 1) {
        for (const auto& triangle : mesh.triangles)
            for (const uint32_t vertex : triangle) first_[vertex + 1] += 2;
        for (size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
        all_.resize(first_.back());
        std::vector<size_t> next(first_.begin(), first_.end() - 1);
        for (const auto& triangle : mesh.triangles) {
            for (size_t corner = 0; corner < 3; ++corner) {
                all_[next[triangle[corner]]++] = triangle[(corner + 1) % 3];
                all_[next[triangle[corner]]++] = triangle[(corner + 2) % 3];
            }
        }
    }

    std::span<const uint32_t> of(uint32_t vertex) const {
        return std::span(all_).subspan(first_[vertex], first_[vertex + 1] - first_[vertex]);
    }

  private:
    std::vector<size_t> first_;
    std::vector<uint32_t> all_;
};

}  // namespace

std::optional<FilledSurface> filled_unseen(const Mesh& mesh, const MeshReflectance& reflectance) {
    const bool reflects = !reflectance.kd.empty();
    std::vector<uint8_t> seen(mesh.positions_m.size());
    for (size_t i = 0; i < seen.size(); ++i)
        seen[i] = mesh.colors[i] != glm::vec3(0) || (reflects && reflectance.kd[i].a > 0);
    const auto count = std::ranges::count(seen, 1);
    if (count == 0 || count == std::ssize(seen)) return std::nullopt;

    const Neighbours neighbours(mesh);
    FilledSurface filled{mesh, reflectance};
    const auto take_from = [&](uint32_t vertex) {
        glm::vec3 color(0);
        glm::vec4 kd(0);
        float colors = 0;
        std::optional<uint32_t> first;
        for (const uint32_t beside : neighbours.of(vertex)) {
            if (!seen[beside]) continue;
            color += filled.mesh.colors[beside];
            colors += filled.mesh.colors[beside] == glm::vec3(0) ? 0.0f : 1.0f;
            first = std::min(first.value_or(beside), beside);
            if (reflects && filled.reflectance.kd[beside].a > 0)
                kd += glm::vec4(glm::vec3(filled.reflectance.kd[beside]), 1);
        }
        filled.mesh.colors[vertex] = color / std::max(colors, 1.0f);
        if (!reflects) return;
        filled.reflectance.kd[vertex] = kd.a > 0 ? glm::vec4(glm::vec3(kd) / kd.a, 0.5f) : glm::vec4(0);
        filled.reflectance.labels[vertex] = filled.reflectance.labels[*first];
    };

    // Ring by ring around what was seen.
    std::vector<uint32_t> ring;
    for (uint32_t vertex = 0; vertex < seen.size(); ++vertex)
        if (!seen[vertex] && std::ranges::any_of(neighbours.of(vertex), [&](uint32_t v) { return seen[v] != 0; }))
            ring.push_back(vertex);
    std::vector<uint8_t> listed(seen);
    for (const uint32_t vertex : ring) listed[vertex] = 1;
    while (!ring.empty()) {
        for (const uint32_t vertex : ring) take_from(vertex);
        filled.vertices += ring.size();
        for (const uint32_t vertex : ring) seen[vertex] = 1;
        std::vector<uint32_t> next;
        for (const uint32_t vertex : ring) {
            for (const uint32_t beside : neighbours.of(vertex)) {
                if (listed[beside]) continue;
                listed[beside] = 1;
                next.push_back(beside);
            }
        }
        ring = std::move(next);
    }
    return filled;
}

}  // namespace patina
