#include "passes/model/ward_fits.h"

namespace patina {

WardFits::WardFits(vulkan::Device& device, uint32_t labels)
    : labels_(labels),
      fits_(device.create_buffer({"specular.fits", labels * sizeof(gpu::WardFit)})),
      curves_(device.create_buffer({"specular.curves", uint64_t{labels} * gpu::kFitAlphas * sizeof(gpu::FitCurve)})),
      progress_(device.create_buffer({"specular.progress", labels * sizeof(gpu::SegmentProgress)})) {}

void WardFits::reset(graph::Frame& frame) const {
    frame.keep(frame.fill(frame.import(fits_), 0));
    frame.keep(frame.fill(frame.import(progress_), 0));
}

void WardFits::keep(graph::Frame& frame, const WardFitIds& ids) {
    frame.keep(ids.fits);
    frame.keep(ids.curves);
    frame.keep(ids.progress);
}

}  // namespace patina
