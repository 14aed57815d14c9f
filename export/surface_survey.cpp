#include "export/surface_survey.h"

#include "export/mesh_parts.h"

namespace patina {

namespace {

/// A triangle's area along the mean of its vertices' normals.
glm::vec3 smooth_area(const Mesh& mesh, const std::array<uint32_t, 3>& triangle, glm::vec3 area_m2) {
    if (mesh.normals.empty()) return area_m2;
    const glm::vec3 sum = mesh.normals[triangle[0]] + mesh.normals[triangle[1]] + mesh.normals[triangle[2]];
    const float length = glm::length(sum);
    return length > 0.1f ? sum * (glm::length(area_m2) / length) : area_m2;
}

}  // namespace

void SurfaceSurvey::add(const Mesh& mesh, std::span<const uint32_t> labels) {
    for (const auto& triangle : mesh.triangles) {
        const glm::vec3 a = mesh.positions_m[triangle[0]], b = mesh.positions_m[triangle[1]],
                        c = mesh.positions_m[triangle[2]];
        const glm::vec3 area_m2 = 0.5f * glm::cross(b - a, c - a);
        if (glm::dot(area_m2, area_m2) > 0)
            add({(a + b + c) / 3.0f, smooth_area(mesh, triangle, area_m2),
                 labels.empty() ? 0 : label_of(triangle, labels)});
    }
}

/// Where there is no room, every other patch goes, and those that stay stand for it.
void SurfaceSurvey::add(const Patch& patch) {
    if (seen_++ % each_ != 0) return;
    if (patches_.size() == kMostPatches) {
        for (size_t i = 0; i < kMostPatches / 2; ++i) {
            patches_[i] = patches_[2 * i];
            patches_[i].area_m2 *= 2.0f;
        }
        patches_.resize(kMostPatches / 2);
        each_ *= 2;
    }
    patches_.push_back({patch.center_m, patch.area_m2 * static_cast<float>(each_), patch.label});
}

}  // namespace patina
