#include "passes/state/segment_samples.h"

namespace patina {

SegmentSamples::SegmentSamples(vulkan::Device& device, uint32_t labels)
    : labels_(labels),
      counts_(device.create_buffer({"segments.sample_counts", labels * sizeof(gpu::SegmentSampleCount)})),
      kept_(device.create_buffer({"segments.samples", uint64_t{labels} * gpu::kSegmentSamples * sizeof(uint32_t)})),
      kd_(device.create_buffer({"segments.kd", labels * sizeof(gpu::SegmentKd)})) {}

void SegmentSamples::reset(graph::FrameGraph& frame) const {
    frame.keep(frame.fill(frame.import(counts_), 0));
    frame.keep(frame.fill(frame.import(kd_), 0));
}

void SegmentSamples::enlarge(graph::Enlargement& enlargement, uint32_t labels) {
    enlargement.add(counts_, labels * sizeof(gpu::SegmentSampleCount), {.fill = 0});
    enlargement.add(kept_, uint64_t{labels} * gpu::kSegmentSamples * sizeof(uint32_t));
    enlargement.add(kd_, labels * sizeof(gpu::SegmentKd), {.fill = 0});
    enlargement.set(labels_, labels);
}

void SegmentSamples::keep(graph::FrameGraph& frame, const SegmentSampleIds& ids) {
    frame.keep(ids.counts);
    frame.keep(ids.kept);
    frame.keep(ids.kd);
}

void SegmentSamples::visit(graph::StateVisitor& visitor) {
    visitor.value("segments.sample_labels", labels_);
    for (vulkan::BufferRef* buffer : {&counts_, &kept_, &kd_}) visitor.buffer(*buffer);
}

}  // namespace patina
