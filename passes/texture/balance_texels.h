#pragma once

#include "passes/state/texture_band.h"

namespace patina {

/// How a page's pictures are brought to what records know of the surface.
struct TextureBalance {
    graph::BufferId blocks;   ///< gpu::TextureBlock by block of the page, row by row
    graph::BufferId balance;  ///< vec4 by block: factor by channel; a: 1 where it is known
};

/// The blocks of a page: each is kTextureBlock texels wide and high.
glm::uvec2 blocks_of(Extent2D page);

/// Averages the texels of a band that a picture shows, block by block, into `blocks`: gpu::TextureBlock of its page.
graph::BufferId add_average_texels(graph::FrameGraph& frame, const TextureBand& band, const TextureBandIds& ids,
                                   graph::BufferId blocks, Extent2D page);

/// How much brighter the records take the surface around each block of a page to be than the pictures do. Means are
/// over about kBalanceReach_m: that is wide beside a record, so that patterns stay as pictures show them, and narrow
/// beside what light, highlights and gains are off by. Records hit strokes of print or the paper between by chance:
/// what that explains is left out. `blocks`: of all bands of the page. Without `known` no records know the surface:
/// pictures stay as they are.
inline constexpr double kBalanceReach_m = 0.08;
TextureBalance add_balance_blocks(graph::FrameGraph& frame, graph::BufferId blocks, Extent2D page, double texel_m,
                                  bool known);

}  // namespace patina
