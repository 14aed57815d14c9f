#pragma once

#include <cstdint>
#include <vector>

#include "passes/state/texture_band.h"

namespace patina {

/// The triangles that may touch each tile of a band, and the buffers of a whole texture that they are of.
struct PlaceTexelsInputs {
    graph::BufferId vertices;   ///< gpu::TextureVertex[]
    graph::BufferId triangles;  ///< u32[3 * triangles]: vertices
    graph::BufferId tiles;      ///< gpu::TextureTile by tile of the band, row by row
    graph::BufferId lists;      ///< u32[]: triangles, ascending within each tile
};

/// Finds the point of the surface that each texel of a band shows: where its centre lies within a triangle that point
/// of the first one, else the nearest point of a triangle no more than gpu::kGutterTexels away. Texels without any have
/// the normal gpu::kNoSurface. Returns the band's texels with what the vertices around know, and sums that are 0.
TextureBandIds add_place_texels(graph::FrameGraph& frame, const TextureBand& band, const PlaceTexelsInputs& inputs);

}  // namespace patina
