#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "engine/graph/frame_graph.h"
#include "passes/specular/run_network.h"
#include "passes/state/network.h"
#include "passes/state/specular_estimates.h"
#include "passes/state/ward_fits.h"
#include "reconstruction/stages/reflectance_stage.h"
#include "reconstruction/stages/segmentation_stage.h"

namespace patina {

/// How the specular materials of segments are estimated.
struct SpecularSettings {
    bool fit = true;                  ///< Ward's parameters are fitted to the observations
    uint32_t segments_per_frame = 4;  ///< estimated at most
    float memory = 0.93f;             ///< FitWardInputs::memory
    uint32_t seed = 1;                ///< of the voxels that the network is shown
};

/// Specular materials of the map's segments: HemiCNN's estimate (paper, Section 3.6) where there is a network, and a
/// fit of Ward's model. In each frame the segments whose observations changed most are estimated, and in turn those
/// that have waited longest; beside the fit the network estimates those of them that it is not sure of. Lives as long
/// as the segments.
class SpecularStage {
  public:
    /// Throws Error for settings that cannot be met, a network that does not estimate materials, or lack of memory.
    SpecularStage(vulkan::Device& device, const SpecularSettings& settings, uint32_t labels,
                  std::optional<NetworkDescription> network);

    /// Forgets everything; the first thing done with it.
    void reset(graph::FrameGraph& graph) const;

    /// Forgets all but which segments are mirrors for sure, also in the materials of the reflectance.
    void forget_gloss(graph::FrameGraph& graph, ReflectanceStage& reflectance) const;

    /// Announces that there will be `labels` of them.
    void enlarge_labels(graph::Enlargement& enlargement, uint32_t labels);

    /// Estimates what a frame's observations changed: `changed` is what ReflectanceStage::add returned. Replaces
    /// materials of the reflectance.
    void add(graph::FrameGraph& graph, ReflectanceStage& reflectance, const SegmentationStage& segmentation,
             const RecordList& changed, uint32_t frame_index);

    /// gpu::WardFit per label.
    graph::BufferId fits(graph::FrameGraph& graph) const { return fits_.import(graph).fits; }
    /// gpu::PerceptualMaterial per label: the mean of what the network said.
    graph::BufferId means(graph::FrameGraph& graph) const { return estimates_.import(graph).means; }

    /// gpu::MaterialBounds[gpu::kBoundsLevels] per label (add_bound_materials), where materials are fitted; else empty.
    /// `albedo`: ReflectanceStage::add_segments.
    std::optional<graph::BufferId> add_bounds(graph::FrameGraph& graph, graph::BufferId albedo) const;

    void visit(graph::StateVisitor& visitor);

    std::vector<VoxelMap::PoolBytes> memory() const;
    const SpecularSettings& settings() const { return settings_; }
    bool has_network() const { return network_.has_value(); }

  private:
    SpecularSettings settings_;
    SpecularEstimates estimates_;
    WardFits fits_;
    std::optional<Network> network_;
    NetworkVariant network_variant_;
};

}  // namespace patina
