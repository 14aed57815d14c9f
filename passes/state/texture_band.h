#pragma once

#include <cstdint>

#include "engine/graph/frame_graph.h"
#include "engine/vulkan/device.h"
#include "shared/texture/texture.h"

namespace patina {

/// Versions of a band's buffers within one frame.
struct TextureBandIds {
    graph::BufferId texels;  ///< gpu::SurfaceTexel by texel, row by row
    graph::BufferId sums;    ///< vec4 by texel: weighted sum of the albedo by pictures, and of weights
    graph::BufferId known;   ///< u32 by texel: the albedo by records (lib/color/packed_albedo.glsl)
};

/// Versions of a view's texels within one frame (passes/texture/show_texels.h).
struct ViewTexelIds {
    TextureBandIds texels;
    graph::BufferId shown;  ///< vec4 by texel: as sums, of what leaves without highlights
};

/// Some rows of a texture's page while it is baked; small enough for each buffer to be bound whole.
class TextureBand {
  public:
    /// Rows that a page of this width may have in a band: a multiple of gpu::kTextureTile.
    static uint32_t most_rows(uint32_t width);

    /// Throws Error when memory runs out.
    TextureBand(vulkan::Device& device, uint32_t page, uint32_t first_row, Extent2D extent);

    TextureBandIds import(graph::FrameGraph& frame) const;
    static void keep(graph::FrameGraph& frame, const TextureBandIds& ids);

    uint32_t page() const { return page_; }
    uint32_t first_row() const { return first_row_; }
    Extent2D extent() const { return extent_; }
    uint32_t texels() const { return static_cast<uint32_t>(extent_.area()); }

  private:
    uint32_t page_, first_row_;
    Extent2D extent_;
    vulkan::BufferRef texels_, sums_, known_;
};

}  // namespace patina
