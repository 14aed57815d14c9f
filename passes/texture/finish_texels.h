#pragma once

#include "passes/state/texture_band.h"
#include "passes/texture/balance_texels.h"

namespace patina {

/// The albedo of each texel, packed (lib/color/packed_albedo.glsl) with its state: 0 where no surface lies, all is 0; 1
/// where no picture shows it, its albedo is what they show within 3 cm of it, else what records know; 2 where one does:
/// the mean of what pictures say, times the balance between the blocks of its surface around it. Returns u32 by texel.
graph::BufferId add_finish_texels(graph::FrameGraph& frame, const TextureBand& band, const TextureBandIds& ids,
                                  const TextureBalance& balance, Extent2D page);

/// What a word of these holds.
glm::vec3 unpack_albedo(uint32_t word);
inline uint32_t state_of(uint32_t word) { return word >> 30; }

}  // namespace patina
