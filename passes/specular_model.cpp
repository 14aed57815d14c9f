#include "passes/specular_model.h"

#include "engine/core/error.h"
#include "passes/specular/choose_segments.h"
#include "passes/specular/fit_ward.h"
#include "passes/specular/fuse_estimates.h"
#include "passes/specular/hemi_images.h"
#include "passes/specular/run_network.h"

namespace patina {

SpecularModel::SpecularModel(vulkan::Device& device, const SpecularSettings& settings, uint32_t labels,
                             std::optional<NetworkDescription> network)
    : settings_(settings), estimates_(device, labels), fits_(device, labels) {
    if (settings.segments_per_frame == 0) throw Error("specular.segments_per_frame is 0, it must be at least 1");
    if (!(settings.memory >= 0 && settings.memory < 1)) {
        throw Error("specular.memory is ", settings.memory, ", it must be at least 0 and below 1");
    }
    if (!settings.fit && !network)
        throw Error("specular materials are to be estimated by a network, but there is none");
    if (!network) return;
    network_.emplace(device, std::move(*network));
    network_variant_ = preferred_network_variant(device.caps(), *network_, settings.segments_per_frame);
}

void SpecularModel::reset(graph::Frame& frame) const {
    estimates_.reset(frame);
    fits_.reset(frame);
}

void SpecularModel::enlarge_labels(graph::Enlargement& enlargement, uint32_t labels) {
    estimates_.enlarge(enlargement, labels);
    fits_.enlarge(enlargement, labels);
}

void SpecularModel::add(graph::Frame& frame, ReflectanceModel& reflectance, const SegmentationModel& segmentation,
                        const RecordList& changed, uint32_t frame_index) {
    const SpecularInputs inputs = reflectance.add_specular_inputs(frame);
    const SegmentSampleIds samples = segmentation.samples().import(frame);
    SpecularEstimateIds estimates = estimates_.import(frame);
    WardFitIds fits = fits_.import(frame);
    SpecularMaterialIds ids{estimates, fits, inputs.materials};
    const ChosenSegments chosen =
        add_choose_segments(frame,
                            {inputs.records.records, changed, segmentation.table().import(frame).labels, samples.counts,
                             fits_.labels(), inputs.material_count, frame_index + 1},
                            settings_.segments_per_frame, ids);
    if (network_) {
        // Of the network the fit takes a prior, which hardly matters where observations tell enough.
        const SegmentBatch& batch = settings_.fit ? chosen.doubtful : chosen.all;
        const HemiImages hemi = add_hemi_images(frame, inputs.map, inputs.records, segmentation.samples(), samples,
                                                batch, network_->description().map, settings_.seed + frame_index);
        const graph::BufferId w = add_run_network(frame, *network_, hemi.images, batch, network_variant_);
        add_fuse_estimates(frame, batch, w, hemi.drawn, estimates_, ids.estimates);
    }
    if (settings_.fit) {
        const FitWardInputs fit{inputs.map,      inputs.records,          inputs.status,
                                inputs.lights,   inputs.position_version, segmentation.samples(),
                                samples,         ids.estimates.materials, inputs.material_count,
                                settings_.memory};
        add_fit_ward(frame, fit, chosen.all, fits_, ids.fits, ids.materials);
    } else {
        add_adopt_estimates(frame, chosen.all, inputs.material_count, ids);
    }
    SpecularEstimates::keep(frame, ids.estimates);
    WardFits::keep(frame, ids.fits);
    frame.keep(ids.materials);
}

std::vector<VoxelMap::PoolBytes> SpecularModel::memory() const {
    std::vector<VoxelMap::PoolBytes> pools{{"specular estimates", estimates_.bytes() + fits_.bytes()}};
    if (network_) pools.push_back({"network", network_->bytes()});
    return pools;
}

}  // namespace patina
