#include "reconstruction/stages/stages.h"

#include "engine/core/error.h"
#include "engine/core/seed.h"

namespace patina {

namespace {

/// Throws Error where a stage lacks what it needs of another.
const ReconstructionSettings& checked(const ReconstructionSettings& settings) {
    if (settings.gains && !settings.fusion.color) {
        throw Error("gains are estimated from fused colours, but fusion.color is false");
    }
    if (settings.specular && !(settings.reflectance && settings.segmentation)) {
        throw Error(
            "specular materials are estimated from the reflectance of "
            "segments, but there ",
            settings.reflectance ? "are no segments" : "is no reflectance");
    }
    return settings;
}

GeometrySettings geometry_of(const ReconstructionSettings& settings) {
    FusionSettings fusion = settings.fusion;
    fusion.seed = seed_of_draw(fusion.seed, settings.seed);
    return {settings.map, fusion, settings.near_m, settings.remove_every, settings.around_m};
}

}  // namespace

Stages::Stages(vulkan::Device& device, const ReconstructionSettings& given)
    : settings(checked(given)), geometry(device, geometry_of(given)) {
    const VoxelMap& map = geometry.map();
    if (settings.gains) color_correction.emplace(device, map, *settings.gains, geometry.access());
    if (settings.segmentation) {
        SegmentationSettings seeded = *settings.segmentation;
        seeded.sample_seed = seed_of_draw(seeded.sample_seed, settings.seed);
        segmentation.emplace(device, map, seeded, geometry.access());
    }
    if (settings.reflectance) {
        if (segmentation) settings.reflectance->capacity_labels = segmentation->table().capacity();
        reflectance.emplace(device, map, *settings.reflectance);
    }
    if (settings.specular) {
        SpecularSettings seeded = *settings.specular;
        seeded.seed = seed_of_draw(seeded.seed, settings.seed);
        specular.emplace(device, seeded, segmentation->table().capacity(), settings.network);
    }
    if (settings.tracking) tracking.emplace(device, *settings.tracking);
    if (settings.keyframes) {
        KeyframeSettings seeded = *settings.keyframes;
        seeded.store.seed = seed_of_draw(seeded.store.seed, settings.seed);
        keyframes.emplace(device, seeded);
    }
}

void Stages::reset(graph::FrameGraph& graph, glm::dvec3 center_m) {
    geometry.reset(graph, center_m);
    if (color_correction) color_correction->reset(graph);
    if (reflectance) reflectance->reset(graph, center_m);
    if (segmentation) segmentation->reset(graph);
    if (specular) specular->reset(graph);
    if (keyframes) keyframes->reset(graph);
}

void Stages::forget_observations(graph::FrameGraph& graph, glm::dvec3 center_m, uint32_t next_frame) {
    if (reflectance) reflectance->reset(graph, center_m);
    if (segmentation) segmentation->forget_samples(graph, next_frame);
    if (specular) specular->forget_gloss(graph, *reflectance);
}

void Stages::visit(graph::StateVisitor& visitor) {
    geometry.visit(visitor);
    if (color_correction) color_correction->visit(visitor);
    if (segmentation) segmentation->visit(visitor);
    if (reflectance) reflectance->visit(visitor);
    if (specular) specular->visit(visitor);
    if (tracking) tracking->visit(visitor);
    if (keyframes) keyframes->visit(visitor);
}

}  // namespace patina
