#pragma once

#include <cmath>
#include <cstdint>

#include "patina/scene.h"

namespace patina::test {

/// A wavy sheet of width x height vertices with exact normals and varying colours.
inline Mesh wavy_sheet(uint32_t width, uint32_t height) {
    Mesh mesh;
    for (uint32_t y = 0; y < height; ++y) {
        for (uint32_t x = 0; x < width; ++x) {
            const float u = static_cast<float>(x) * 0.01f, v = static_cast<float>(y) * 0.01f;
            mesh.positions_m.emplace_back(u, v, 0.1f * std::sin(7 * u));
            mesh.normals.push_back(glm::normalize(glm::vec3(-0.7f * std::cos(7 * u), 0, 1)));
            mesh.colors.emplace_back(std::fmod(u, 1.0f), std::fmod(v, 1.0f), 0.25f);
        }
    }
    for (uint32_t y = 0; y + 1 < height; ++y) {
        for (uint32_t x = 0; x + 1 < width; ++x) {
            const uint32_t i = y * width + x;
            mesh.triangles.push_back({i, i + 1, i + width});
            mesh.triangles.push_back({i + 1, i + width + 1, i + width});
        }
    }
    return mesh;
}

}  // namespace patina::test
