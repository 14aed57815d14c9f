#pragma once

#include <cstdint>
#include <vector>

#include "export/tidy_surface.h"
#include "patina/texture.h"

namespace patina {

/// How fine a texture is.
struct TextureOptions {
    double texel_m =
        0.002;  ///< edge of a texel on the surface; larger where the pages, or one for a triangle, do not suffice
    uint32_t most_pages = 4;
    uint32_t page = 4096;  ///< texels along a side
};

/// Lays a surface out in the pages of a texture, chart by chart (find_charts). Triangles without area are left out. The
/// same surface gives the same layout.
TextureLayout lay_out_texture(std::vector<TidyPiece> pieces, const TextureOptions& options);

}  // namespace patina
