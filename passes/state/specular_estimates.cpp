#include "passes/state/specular_estimates.h"

namespace patina {

SpecularEstimates::SpecularEstimates(vulkan::Device& device, uint32_t labels)
    : labels_(labels),
      means_(device.create_buffer({"specular.means", labels * sizeof(gpu::PerceptualMaterial)})),
      materials_(device.create_buffer({"specular.materials", labels * sizeof(gpu::WardMaterial)})) {}

void SpecularEstimates::reset(graph::FrameGraph& frame) const {
    frame.keep(frame.fill(frame.import(means_), 0));
    frame.keep(frame.fill(frame.import(materials_), 0));
}

void SpecularEstimates::enlarge(graph::Enlargement& enlargement, uint32_t labels) {
    enlargement.add(means_, labels * sizeof(gpu::PerceptualMaterial), {.fill = 0});
    enlargement.add(materials_, labels * sizeof(gpu::WardMaterial), {.fill = 0});
    enlargement.set(labels_, labels);
}

void SpecularEstimates::keep(graph::FrameGraph& frame, const SpecularEstimateIds& ids) {
    frame.keep(ids.means);
    frame.keep(ids.materials);
}

void SpecularEstimates::visit(graph::StateVisitor& visitor) {
    visitor.value("specular.estimate_labels", labels_);
    for (vulkan::BufferRef* buffer : {&means_, &materials_}) visitor.buffer(*buffer);
}

}  // namespace patina
