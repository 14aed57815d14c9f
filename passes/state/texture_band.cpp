#include "passes/state/texture_band.h"

#include <algorithm>

namespace patina {

namespace {

constexpr uint64_t kMostBytes = 48u << 20;  // of a buffer: every device binds it, and dispatches a group per 64 texels

}  // namespace

uint32_t TextureBand::most_rows(uint32_t width) {
    const uint64_t rows = kMostBytes / (sizeof(gpu::SurfaceTexel) * uint64_t{std::max(width, 1u)});
    return std::max(static_cast<uint32_t>(rows) / gpu::kTextureTile, 1u) * gpu::kTextureTile;
}

TextureBand::TextureBand(vulkan::Device& device, uint32_t page, uint32_t first_row, Extent2D extent)
    : page_(page),
      first_row_(first_row),
      extent_(extent),
      texels_(device.create_buffer({.name = "texels", .bytes = extent.area() * sizeof(gpu::SurfaceTexel)})),
      sums_(device.create_buffer({.name = "sums of texels", .bytes = extent.area() * sizeof(glm::vec4)})),
      known_(device.create_buffer({.name = "known albedo of texels", .bytes = extent.area() * sizeof(uint32_t)})) {}

TextureBandIds TextureBand::import(graph::FrameGraph& frame) const {
    return {frame.import(texels_), frame.import(sums_), frame.import(known_)};
}

void TextureBand::keep(graph::FrameGraph& frame, const TextureBandIds& ids) {
    frame.keep(ids.texels);
    frame.keep(ids.sums);
    frame.keep(ids.known);
}

}  // namespace patina
