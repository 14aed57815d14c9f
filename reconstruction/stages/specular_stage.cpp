#include "reconstruction/stages/specular_stage.h"

#include "engine/core/error.h"
#include "passes/specular/bound_materials.h"
#include "passes/specular/choose_segments.h"
#include "passes/specular/fit_mirrors.h"
#include "passes/specular/fit_ward.h"
#include "passes/specular/fuse_estimates.h"
#include "passes/specular/hemi_images.h"
#include "passes/specular/keep_mirrors.h"
#include "passes/specular/run_network.h"

namespace patina {

SpecularStage::SpecularStage(vulkan::Device& device, const SpecularSettings& settings, uint32_t labels,
                             std::optional<NetworkDescription> network)
    : settings_(settings), estimates_(device, labels), fits_(device, labels) {
    if (settings.segments_per_frame == 0) throw Error("specular.segments_per_frame is 0, it must be at least 1");
    if (!(settings.memory >= 0 && settings.memory < 1)) {
        throw Error("specular.memory is ", settings.memory, ", it must be at least 0 and below 1");
    }
    if (!settings.fit && !network)
        throw Error(
            "specular materials are to be estimated by a network, but "
            "there is none");
    if (!network) return;
    network_.emplace(device, std::move(*network));
    network_variant_ = preferred_network_variant(device.caps(), *network_, settings.segments_per_frame);
}

void SpecularStage::reset(graph::FrameGraph& graph) const {
    estimates_.reset(graph);
    fits_.reset(graph);
}

void SpecularStage::forget_gloss(graph::FrameGraph& graph, ReflectanceStage& reflectance) const {
    estimates_.reset(graph);
    fits_.forget_gloss(graph);
    const SpecularInputs inputs = reflectance.add_specular_inputs(graph);
    WardFitIds fits = fits_.import(graph);
    graph::BufferId materials = inputs.materials;
    add_keep_mirrors(graph, fits_, fits, inputs.material_count, materials);
    graph.keep(fits.mirrors);
    graph.keep(materials);
}

void SpecularStage::enlarge_labels(graph::Enlargement& enlargement, uint32_t labels) {
    estimates_.enlarge(enlargement, labels);
    fits_.enlarge(enlargement, labels);
}

void SpecularStage::add(graph::FrameGraph& graph, ReflectanceStage& reflectance, const SegmentationStage& segmentation,
                        const RecordList& changed, uint32_t frame_index) {
    const SpecularInputs inputs = reflectance.add_specular_inputs(graph);
    const SegmentSampleIds samples = segmentation.samples().import(graph);
    SpecularEstimateIds estimates = estimates_.import(graph);
    WardFitIds fits = fits_.import(graph);
    SpecularMaterialIds ids{estimates, fits, inputs.materials};
    const ChosenSegments chosen =
        add_choose_segments(graph,
                            {inputs.records.records, changed, segmentation.table().import(graph).labels, samples.counts,
                             fits_.labels(), inputs.material_count, frame_index + 1},
                            settings_.segments_per_frame, ids);
    if (inputs.surroundings) {
        add_fit_mirrors(graph,
                        {inputs.map, inputs.records, *inputs.surroundings, samples, inputs.material_count,
                         frame_index + 1, settings_.memory},
                        chosen.all, fits_, ids.fits, ids.materials);
    }
    if (network_ && !reflectance.lights().point_lights().empty()) {  // it tells nothing without a lamp
        // Of the network the fit takes a prior, which hardly matters where observations tell enough.
        const SegmentBatch& batch = settings_.fit ? chosen.doubtful : chosen.all;
        const HemiImages hemi = add_hemi_images(graph, inputs.map, inputs.records, segmentation.samples(), samples,
                                                batch, network_->description().map, settings_.seed + frame_index);
        const graph::BufferId w = add_run_network(graph, *network_, hemi.images, batch, network_variant_);
        add_fuse_estimates(graph, batch, w, hemi.drawn, estimates_, ids.estimates);
    }
    if (settings_.fit) {
        const FitWardInputs fit{inputs.map,      inputs.records,          inputs.status,
                                inputs.lights,   inputs.position_version, segmentation.samples(),
                                samples,         ids.estimates.materials, inputs.material_count,
                                settings_.memory};
        add_fit_ward(graph, fit, chosen.all, fits_, ids.fits, ids.materials);
    } else {
        add_adopt_estimates(graph, chosen.all, inputs.material_count, ids);
    }
    SpecularEstimates::keep(graph, ids.estimates);
    WardFits::keep(graph, ids.fits);
    graph.keep(ids.materials);
}

std::optional<graph::BufferId> SpecularStage::add_bounds(graph::FrameGraph& graph, graph::BufferId albedo) const {
    if (!settings_.fit) return std::nullopt;
    return add_bound_materials(graph, {fits_, fits_.import(graph), albedo});
}

std::vector<VoxelMap::PoolBytes> SpecularStage::memory() const {
    std::vector<VoxelMap::PoolBytes> pools{{"specular estimates", estimates_.bytes() + fits_.bytes()}};
    if (network_) pools.push_back({"network", network_->bytes()});
    return pools;
}

void SpecularStage::visit(graph::StateVisitor& visitor) {
    estimates_.visit(visitor);
    fits_.visit(visitor);
}

}  // namespace patina
