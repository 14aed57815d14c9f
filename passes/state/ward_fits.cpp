#include "passes/state/ward_fits.h"

#include <algorithm>

namespace patina {

uint32_t WardFits::most_labels(const vulkan::DeviceCaps& caps) {
    return static_cast<uint32_t>(
        std::min<uint64_t>(caps.max_storage_range / (gpu::kFitAlphas * sizeof(gpu::FitCurve)), UINT32_MAX));
}

WardFits::WardFits(vulkan::Device& device, uint32_t labels)
    : labels_(labels),
      fits_(device.create_buffer({"specular.fits", labels * sizeof(gpu::WardFit)})),
      curves_(device.create_buffer({"specular.curves", uint64_t{labels} * gpu::kFitAlphas * sizeof(gpu::FitCurve)})),
      progress_(device.create_buffer({"specular.progress", labels * sizeof(gpu::SegmentProgress)})),
      mirrors_(device.create_buffer({"specular.mirrors", labels * sizeof(gpu::MirrorFit)})) {}

void WardFits::reset(graph::FrameGraph& frame) const {
    forget_gloss(frame);
    frame.keep(frame.fill(frame.import(mirrors_), 0));
}

void WardFits::forget_gloss(graph::FrameGraph& frame) const {
    frame.keep(frame.fill(frame.import(fits_), 0));
    frame.keep(frame.fill(frame.import(progress_), 0));
}

void WardFits::enlarge(graph::Enlargement& enlargement, uint32_t labels) {
    enlargement.add(fits_, labels * sizeof(gpu::WardFit), {.fill = 0});
    enlargement.add(curves_, uint64_t{labels} * gpu::kFitAlphas * sizeof(gpu::FitCurve));
    enlargement.add(progress_, labels * sizeof(gpu::SegmentProgress), {.fill = 0});
    enlargement.add(mirrors_, labels * sizeof(gpu::MirrorFit), {.fill = 0});
    enlargement.set(labels_, labels);
}

void WardFits::keep(graph::FrameGraph& frame, const WardFitIds& ids) {
    frame.keep(ids.fits);
    frame.keep(ids.curves);
    frame.keep(ids.progress);
    frame.keep(ids.mirrors);
}

void WardFits::visit(graph::StateVisitor& visitor) {
    visitor.value("specular.fit_labels", labels_);
    for (vulkan::BufferRef* buffer : {&fits_, &curves_, &progress_, &mirrors_}) visitor.buffer(*buffer);
}

}  // namespace patina
