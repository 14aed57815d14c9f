#pragma once

#include <optional>

#include "reconstruction/reconstruction_settings.h"
#include "reconstruction/stages/color_correction.h"
#include "reconstruction/stages/geometry_stage.h"

namespace patina {

/// The stages of a reconstruction. Each owns its part of what outlives a frame, and adds its passes to the frame's
/// graph (reconstruction/frame_graph.h joins them). Those that the settings leave out are empty.
struct Stages {
    /// Throws Error for settings that cannot be met, or lack of memory.
    Stages(vulkan::Device& device, const ReconstructionSettings& settings);
    Stages(const Stages&) = delete;
    Stages& operator=(const Stages&) = delete;

    /// Empties all of them, for a map around `center_m`; before the first frame.
    void reset(graph::FrameGraph& graph, glm::dvec3 center_m);

    /// Forgets what was observed before frame `next_frame`, but neither the surface with its segments nor which of
    /// these are mirrors. `center_m`: as of reset().
    void forget_observations(graph::FrameGraph& graph, glm::dvec3 center_m, uint32_t next_frame);

    void visit(graph::StateVisitor& visitor);

    /// Whether anything needs the model as the depth camera of each frame sees it.
    bool need_raycast() const { return segmentation || reflectance || tracking || settings.view_every_frame; }
    /// Whether tracking compares shades, too.
    bool track_shades() const { return tracking && settings.fusion.color && tracking->settings().photometric; }

    ReconstructionSettings settings;  ///< as given, but for reflectance.capacity_labels, which is that of the segments
    GeometryStage geometry;
    std::optional<ColorCorrection> color_correction;
    std::optional<SegmentationStage> segmentation;
    std::optional<ReflectanceStage> reflectance;
    std::optional<SpecularStage> specular;
    std::optional<TrackingStage> tracking;
    std::optional<KeyframeStage> keyframes;
};

/// The stage, or null where there is none.
template <class Stage>
auto* pointer_to(Stage& stage) {
    return stage ? &*stage : nullptr;
}

}  // namespace patina
