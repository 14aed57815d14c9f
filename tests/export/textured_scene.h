#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "patina/scene.h"
#include "patina/texture.h"

namespace patina::test {

/// Segments 1 and 2: a quad each, one in each of two pages; 3 has next to no diffuse albedo and is a metal.
inline TextureLayout three_quads() {
    TextureLayout layout{0.002, {{64, 32}, {16, 16}}, {}, {}};
    TexturedSurface& piece = layout.pieces.emplace_back();
    piece.reflectance.segments.resize(4);
    piece.reflectance.segments[1].kd = glm::vec3(0.5f, 0.25f, 0.125f);
    piece.reflectance.segments[2].kd = glm::vec3(0.2f);
    piece.reflectance.segments[2].gloss = WardGloss{glm::vec3(0.1f), 0.1f, 0.9f};
    piece.reflectance.segments[3].kd = glm::vec3(0.01f);
    piece.reflectance.segments[3].gloss = WardGloss{glm::vec3(0.9f), 0.1f, 0.9f};
    for (uint32_t label = 1; label <= 3; ++label) {
        const auto first = static_cast<uint32_t>(piece.place_px.size());
        const uint32_t page = label == 2 ? 1 : 0;
        const glm::vec2 corner(label == 3 ? 40.0f : 4.0f, 4.0f);
        for (const glm::vec2 at : {glm::vec2(0, 0), glm::vec2(1, 0), glm::vec2(0, 1), glm::vec2(1, 1)}) {
            piece.mesh.positions_m.emplace_back(at, static_cast<float>(label));
            piece.mesh.normals.emplace_back(0, 0, 1);
            piece.mesh.colors.emplace_back(0.5f);
            piece.reflectance.kd.emplace_back(0.3f, 0.3f, 0.3f, 1.0f);
            piece.reflectance.labels.push_back(label);
            piece.place_px.push_back(corner + 8.0f * at);
            piece.pages.push_back(page);
        }
        piece.mesh.triangles.push_back({first, first + 1, first + 2});
        piece.mesh.triangles.push_back({first + 1, first + 3, first + 2});
        const glm::uvec2 low(corner - 3.0f);
        layout.boxes.push_back({page, low, low + 14u, label});
    }
    return layout;
}

/// Pages of one albedo where three_quads() shows them; part of it no picture saw.
inline std::vector<TexturePage> painted(const TextureLayout& layout, glm::vec3 kd) {
    std::vector<TexturePage> pages;
    for (const Extent2D extent : layout.pages) {
        TexturePage page{Image<glm::vec3>(extent), Image<TexelState>(extent, TexelState::kEmpty)};
        for (uint32_t y = 4; y < 12; ++y) {
            for (uint32_t x = 4; x < 12; ++x) {
                page.kd.at(x, y) = kd;
                page.states.at(x, y) = x < 10 ? TexelState::kSeen : TexelState::kFilled;
            }
        }
        pages.push_back(std::move(page));
    }
    return pages;
}

}  // namespace patina::test
