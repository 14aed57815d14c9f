#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "patina/texture.h"
#include "shared/texture/texture.h"

namespace patina {

/// A layout as shaders read it.
struct TextureTriangles {
    std::vector<gpu::TextureVertex> vertices;
    std::vector<glm::vec4> tangents;  ///< by vertex; empty where the layout has none
    std::vector<uint32_t> indices;    ///< three per triangle
    std::vector<uint32_t> pages;      ///< by triangle
};

/// All pieces of a layout, one after the other. A vertex whose albedo is not known has its segment's, without one its
/// own colour.
TextureTriangles texture_triangles(const TextureLayout& layout);

/// The same in pages of other extents: places move with the page that they are in.
TextureTriangles resized(TextureTriangles triangles, std::span<const Extent2D> from, std::span<const Extent2D> to);

/// Which triangles may touch each tile of a band: those that come as near as the gutter to it.
struct TileLists {
    std::vector<gpu::TextureTile> tiles;  ///< row by row
    std::vector<uint32_t> lists;          ///< triangles, ascending within each tile; never empty
};
TileLists list_tiles(const TextureTriangles& triangles, uint32_t page, uint32_t first_row, Extent2D extent);

}  // namespace patina
