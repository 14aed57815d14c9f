#include "passes/state/away_albedo.h"

namespace patina {

namespace {

constexpr uint64_t kLabelBytes = gpu::kSweepParts * sizeof(gpu::SegmentAlbedo);

}  // namespace

AwayAlbedo::AwayAlbedo(vulkan::Device& device, uint32_t labels)
    : sums_(device.create_buffer({"reflectance.away", labels * kLabelBytes})) {}

void AwayAlbedo::reset(graph::FrameGraph& frame) const { frame.keep(frame.fill(frame.import(sums_), 0)); }

void AwayAlbedo::enlarge(graph::Enlargement& enlargement, uint32_t labels) {
    enlargement.add(sums_, labels * kLabelBytes, {.fill = 0});
}

}  // namespace patina
