#include "passes/state/segment_materials.h"

#include <cmath>

#include "engine/core/error.h"

namespace patina {

SegmentMaterials::SegmentMaterials(vulkan::Device& device, uint32_t capacity) : capacity_(capacity) {
    if (capacity == 0 || capacity > kMaxCapacity) {
        throw Error("the table of materials is for ", capacity, " labels, it must be 1 to ", kMaxCapacity);
    }
    materials_.resize(capacity);
    buffer_ = device.create_buffer({.name = "segment_materials", .bytes = capacity * sizeof(gpu::SegmentMaterial)});
}

void SegmentMaterials::set(uint32_t label, glm::vec3 ks, float alpha) {
    if (label == 0 || label >= kMaxCapacity) {
        throw Error("a material was set for label ", label, ", labels go from 1 to ", kMaxCapacity - 1);
    }
    const bool valid = glm::all(glm::greaterThanEqual(ks, glm::vec3(0))) && !glm::any(glm::isinf(ks)) && alpha > 0 &&
                       std::isfinite(alpha);
    if (!valid) {
        throw Error("the material of label ", label, " has ks (", ks.r, ", ", ks.g, ", ", ks.b, ") and alpha ", alpha,
                    ", they must be at least 0 and above 0");
    }
    if (label >= materials_.size()) materials_.resize(label + 1);
    gpu::SegmentMaterial& material = materials_[label];
    const glm::vec4 ks_alpha(ks, alpha);
    if (material.version != 0 && material.ks_alpha == ks_alpha) return;
    material.ks_alpha = ks_alpha;
    // Records keep 16 bits of it.
    material.version = ++changes_ % 0xffffu + 1;
    uploaded_ = false;
}

void SegmentMaterials::enlarge(graph::Enlargement& enlargement, uint32_t capacity) {
    if (capacity <= capacity_) return;
    enlargement.add(buffer_, capacity * sizeof(gpu::SegmentMaterial), {.fill = 0});
    // The device holds what it estimated itself, which is replaced only by what was set for a label beyond its
    // capacity.
    if (materials_.size() > capacity_) enlargement.set(uploaded_, false);
    enlargement.set(capacity_, capacity);
}

graph::BufferId SegmentMaterials::import(graph::FrameGraph& frame) {
    graph::BufferId id = frame.import(buffer_);
    if (uploaded_) return id;
    if (materials_.size() < capacity_) materials_.resize(capacity_);
    id = frame.upload_bytes(id, 0, std::as_bytes(std::span(materials_).first(capacity_)), true);
    frame.keep(id);
    uploaded_ = true;
    return id;
}

void SegmentMaterials::visit(graph::StateVisitor& visitor) {
    visitor.value("materials.capacity", capacity_);
    visitor.value("materials.changes", changes_);
    visitor.value("materials.uploaded", uploaded_);
    visitor.values("materials.set", materials_);
    visitor.buffer(buffer_);
}

}  // namespace patina
