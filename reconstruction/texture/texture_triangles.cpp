#include "reconstruction/texture/texture_triangles.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace patina {
namespace {

using PageCorners = std::array<glm::vec2, 3>;

static_assert(gpu::kGutterTexels == kTextureGutter);
constexpr float kTile = gpu::kTextureTile;
constexpr float kReach_px = gpu::kGutterTexels + 1.0f;  // of a triangle beyond its border, and what rounding needs

glm::vec3 known_albedo(const TexturedSurface& piece, size_t vertex) {
    const MeshReflectance& reflectance = piece.reflectance;
    if (reflectance.kd.empty()) return glm::clamp(piece.mesh.colors[vertex], 0.0f, 1.0f);
    if (reflectance.kd[vertex].a > 0) return glm::vec3(reflectance.kd[vertex]);
    const uint32_t label = reflectance.labels[vertex];
    const bool has_mean = label < reflectance.segments.size() && reflectance.segments[label].kd;
    return has_mean ? *reflectance.segments[label].kd : glm::clamp(piece.mesh.colors[vertex], 0.0f, 1.0f);
}

/// Whether a tile lies beyond one of the triangle's edges by more than kReach_px.
bool is_apart(const PageCorners& corners, glm::vec2 low, glm::vec2 high) {
    const glm::vec2 a = corners[1] - corners[0], b = corners[2] - corners[0];
    const float turn = a.x * b.y - a.y * b.x < 0 ? -1.0f : 1.0f;
    for (size_t i = 0; i < 3; ++i) {
        const glm::vec2 edge = corners[(i + 1) % 3] - corners[i];
        const glm::vec2 inwards = turn * glm::vec2(-edge.y, edge.x);
        const glm::vec2 farthest(inwards.x > 0 ? high.x : low.x, inwards.y > 0 ? high.y : low.y);
        if (glm::dot(farthest - corners[i], inwards) < -kReach_px * glm::length(edge)) return true;
    }
    return false;
}

/// Calls `take` with each tile of the band that a triangle may touch.
template <class Take>
void for_tiles(const PageCorners& corners, uint32_t first_row, glm::uvec2 tiles, const Take& take) {
    const glm::vec2 origin(0, static_cast<float>(first_row));
    glm::vec2 low = corners[0] - origin, high = low;
    for (const glm::vec2 corner : corners) {
        low = glm::min(low, corner - origin);
        high = glm::max(high, corner - origin);
    }
    const glm::ivec2 first = glm::max(glm::ivec2(glm::floor((low - kReach_px) / kTile)), 0);
    const glm::ivec2 last = glm::min(glm::ivec2(glm::floor((high + kReach_px) / kTile)), glm::ivec2(tiles) - 1);
    for (int y = first.y; y <= last.y; ++y) {
        for (int x = first.x; x <= last.x; ++x) {
            const glm::vec2 at = origin + kTile * glm::vec2(x, y);
            if (!is_apart(corners, at, at + kTile)) take(static_cast<size_t>(y) * tiles.x + static_cast<size_t>(x));
        }
    }
}

}  // namespace

TextureTriangles texture_triangles(const TextureLayout& layout) {
    TextureTriangles all;
    for (const TexturedSurface& piece : layout.pieces) {
        const auto first = static_cast<uint32_t>(all.vertices.size());
        for (size_t i = 0; i < piece.place_px.size(); ++i) {
            const glm::vec2 place = piece.place_px[i];
            all.vertices.push_back({glm::vec4(piece.mesh.positions_m[i], place.x),
                                    glm::vec4(known_albedo(piece, i), place.y), glm::vec4(piece.mesh.normals[i], 0)});
        }
        all.tangents.insert(all.tangents.end(), piece.tangents.begin(), piece.tangents.end());
        for (const auto& triangle : piece.mesh.triangles) {
            for (const uint32_t vertex : triangle) all.indices.push_back(first + vertex);
            all.pages.push_back(piece.pages[triangle[0]]);
        }
    }
    return all;
}

TextureTriangles resized(TextureTriangles triangles, std::span<const Extent2D> from, std::span<const Extent2D> to) {
    std::vector<uint8_t> done(triangles.vertices.size(), 0);
    for (size_t i = 0; i < triangles.indices.size(); ++i) {
        const uint32_t vertex = triangles.indices[i], page = triangles.pages[i / 3];
        if (done[vertex]++ > 0) continue;
        gpu::TextureVertex& own = triangles.vertices[vertex];
        own.position_m.w *= static_cast<float>(to[page].width) / static_cast<float>(from[page].width);
        own.kd.w *= static_cast<float>(to[page].height) / static_cast<float>(from[page].height);
    }
    return triangles;
}

TileLists list_tiles(const TextureTriangles& triangles, uint32_t page, uint32_t first_row, Extent2D extent) {
    const glm::uvec2 tiles((extent.width + gpu::kTextureTile - 1) / gpu::kTextureTile,
                           (extent.height + gpu::kTextureTile - 1) / gpu::kTextureTile);
    TileLists found;
    found.tiles.resize(size_t{tiles.x} * tiles.y);
    const auto for_all = [&](const auto& take) {
        for (uint32_t t = 0; t < triangles.pages.size(); ++t) {
            if (triangles.pages[t] != page) continue;
            PageCorners corners;
            for (size_t i = 0; i < 3; ++i) {
                const gpu::TextureVertex& vertex = triangles.vertices[triangles.indices[3 * t + i]];
                corners[i] = {vertex.position_m.w, vertex.kd.w};
            }
            for_tiles(corners, first_row, tiles, [&](size_t tile) { take(t, tile); });
        }
    };
    for_all([&](uint32_t, size_t tile) { ++found.tiles[tile].count; });
    uint32_t total = 0;
    for (gpu::TextureTile& tile : found.tiles) {
        tile.first = total;
        total += tile.count;
        tile.count = 0;
    }
    found.lists.resize(std::max(total, 1u));
    for_all([&](uint32_t t, size_t tile) {
        gpu::TextureTile& own = found.tiles[tile];
        found.lists[own.first + own.count++] = t;
    });
    return found;
}

}  // namespace patina
