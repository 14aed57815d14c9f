#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "passes/fusion/raycast.h"
#include "passes/observation/observation.h"
#include "passes/observation/stream_records.h"
#include "passes/reflectance/average_segments.h"
#include "passes/reflectance/collect_surroundings.h"
#include "passes/reflectance/reflectance.h"
#include "passes/shading/predict_radiance.h"
#include "passes/shading/sample_reflectance.h"
#include "passes/state/away_albedo.h"
#include "reconstruction/frame_context.h"

namespace patina {

/// Size and settings of the reflectance beside the geometry.
struct ReflectanceStageSettings {
    /// Of observations: half or a quarter of a voxel block. 0: whichever is nearer to 2 cm, which is what settings() of
    /// the stage then says.
    float voxel_m = 0;
    uint32_t capacity_blocks = 65536;    ///< at first
    uint32_t capacity_records = 262144;  ///< at first
    uint32_t limit_blocks = 0;           ///< beyond which the pool does not grow; 0: as far as buffers and memory allow
    uint32_t limit_records = 0;          ///< likewise
    /// While more are in use, observed voxels that are far away leave the device; 0: none do.
    uint32_t resident_records = 524288;
    /// Frames after which a part of the observations gives back what holds no surface any more; 0: never
    uint32_t reclaim_every = 16;
    bool detail = true;  ///< pictures show detail that is restored from the fused colour
    /// Rays of a glossy pixel by which kept pictures mirror what is around (ReflectSurroundingsInputs::rays); 0: gloss
    /// shows the mean of it, as in the window. None without light that records gather.
    uint32_t mirrored_rays = 16;
    ObservationSettings observe;
    ReflectanceSettings refine{.gathered_rays = 4};
    uint32_t capacity_labels = 4096;  ///< materials by label, label 0 included; at first that of the segments
};

/// What a camera sees of the reflectance.
struct PredictedView {
    PredictedImages images;
    graph::BufferId segments;  ///< gpu::SegmentAlbedo per label
};

/// Lights that a view is lit by, in place of those of the reconstruction, which stay as they are. Light that came from
/// all around is that of the former lights, and left out.
struct OtherLights {
    std::vector<Light> lights;
    glm::dvec3 ambient{0};
    /// As they fall from the lights of the reconstruction, one after the other; false: every light reaches every
    /// surface. Where a light was moved, its shadows are not known.
    bool shadows = false;

    bool operator==(const OtherLights&) const = default;
};

/// Light that the model is put under in place of that of the reconstruction.
struct Relighting {
    std::vector<Light> lights;
    glm::dvec3 ambient{0};  ///< Lights::set
    /// Radiance that arrives from far away, by texel of gpu::FarFieldTexel in the map's world; empty: nothing is known.
    std::vector<glm::vec3> far_field;
    /// How often light that surfaces send on is gathered again; 0: the lamps' own light and the ambient term are all,
    /// as where the reconstruction gathers none. Light from far away is gathered once more in any case.
    uint32_t bounces = 2;
};

/// Whether glossy surfaces of a view mirror what is around them, which takes longer than all else of it, or send the
/// mean of it.
enum class Gloss : uint8_t { kMean, kMirrors };

/// What is known of the segments, by label.
struct SegmentIds {
    graph::BufferId albedo;     ///< gpu::SegmentAlbedo per label
    graph::BufferId materials;  ///< gpu::SegmentMaterial per label
};

/// What estimates of specular materials read and replace.
struct SpecularInputs {
    const ObservationMap& map;
    ObservationMapIds records;
    graph::BufferId status;                       ///< gpu::RecordStatus per record
    std::optional<graph::BufferId> surroundings;  ///< of ReflectanceStateIds; empty where no light is gathered
    graph::BufferId lights;                       ///< Lights::upload
    uint32_t position_version;                    ///< of the lights
    graph::BufferId materials;                    ///< gpu::SegmentMaterial per label; to be kept once replaced
    uint32_t material_count;
};

/// What a surface reflects, beside the voxel map that says where it is: observations by voxel, the lights, materials by
/// label, and kd refined from them (paper, Sections 3.4 and 3.7). Lives as long as the map.
class ReflectanceStage {
  public:
    /// Throws Error for settings that cannot be met, or lack of memory. The map must outlive the stage.
    ReflectanceStage(vulkan::Device& device, const VoxelMap& map, const ReflectanceStageSettings& settings);

    /// Replaces all lights; see Lights::set.
    void set_lights(std::span<const Light> lights, glm::dvec3 ambient = glm::dvec3(0));
    /// Sets the specular material of a label; see SegmentMaterials::set.
    void set_material(uint32_t label, glm::vec3 ks, float alpha);

    /// Empties the model, placing it around the map's centre; the first thing done with it.
    void reset(graph::FrameGraph& graph, glm::dvec3 center_m);

    /// Takes a frame of low exposure into the surroundings alone; before the first frame, or after it. `radiance_scale`
    /// is the recording's exposure over the frame's. It is in the world of the frames.
    void add_low_exposure(graph::FrameGraph& graph, const SurroundingsInputs& frame);

    /// The colour cameras of the frames of low exposure.
    const std::vector<gpu::Camera>& low_exposure_cameras() const { return low_exposure_cameras_; }

    /// Collects a frame's observations and refines what they change. Returns the records that they changed.
    RecordList add(graph::FrameGraph& graph, const VoxelMapIds& voxels, const ObservationInputs& inputs,
                   const FrameContext& frame);

    /// Gives back records whose surface went, where that is due: those in whose voxels nothing was seen within `near_m`
    /// of the surface (observation/reclaim_records.h). Whoever keeps record ids must choose them anew in this frame.
    /// add() or keep() comes after it.
    void reclaim(graph::FrameGraph& graph, const VoxelMapIds& voxels, float near_m, const FrameContext& frame);

    /// Ends a frame that add() is not called for: what passes wrote of the observations outlives it.
    void keep(graph::FrameGraph& graph) const;

    /// Announce that a pool of the observations grows; see ObservationMap.
    void enlarge_blocks(graph::Enlargement& enlargement, uint32_t blocks);
    void enlarge_records(graph::Enlargement& enlargement, uint32_t records);
    /// Announces that there will be `labels` materials.
    void enlarge_labels(graph::Enlargement& enlargement, uint32_t labels);

    /// Records outside a region leave the device, and records come back to it (observation/stream_records.h). add() or
    /// keep() comes after it.
    LeavingRecords add_leave(graph::FrameGraph& graph, const gpu::StreamRegion& region, uint32_t most);
    graph::BufferId add_return(graph::FrameGraph& graph, const ReturningRecords& returning);
    /// What is away by label: AwayAlbedo; empty where nothing ever left. add() or keep() comes after it.
    std::optional<graph::BufferId> away(graph::FrameGraph& graph) const;

    /// The observations, for passes beside those of the model; what they write comes before or after add() in a frame.
    const ObservationMap& observations() const { return observations_; }
    /// gpu::RecordStatus per record of the observations.
    graph::BufferId import_status(graph::FrameGraph& graph) const { return state_.import(graph).status; }

    /// What was seen around: see ReflectanceStateIds.
    graph::BufferId import_surroundings(graph::FrameGraph& graph) const { return state_.import(graph).surroundings; }

    /// What the frame's records and materials are so far.
    SpecularInputs add_specular_inputs(graph::FrameGraph& graph);

    /// Brings every record of a part up to date. `gathers`: they gather light once more, too, where settings say so.
    void refine_all(graph::FrameGraph& graph, const VoxelMapIds& voxels, bool gathers, const RefinedPart& part = {});

    /// Puts the model under other light than it was observed under; kd stays. Nothing may be added after that. Returns
    /// the turns by which add_relight() then brings light and colours up to date, each of them for all parts of the
    /// model before the next; none where no light is gathered: refine_all() finds what the lamps light.
    std::vector<RelightTurn> relight(const Relighting& relighting);
    void add_relight(graph::FrameGraph& graph, VoxelMapIds& voxels, const RelightTurn& turn, const RefinedPart& part);
    /// Before the first of the turns: all colours are unknown, and what is around is what arrives from far away.
    void add_forget_light(graph::FrameGraph& graph, VoxelMapIds& voxels, const Relighting& relighting) const;

    /// Lets records tell each other of their albedo before a view is predicted, where any changed since they did so
    /// last, here or in refine_all(). The frame adds nothing else to the model.
    void share_albedo(graph::FrameGraph& graph);

    /// What a camera sees that was cast into the model. `other`: lights in place of those of the reconstruction; may be
    /// null. Throws Error as Lights::set does.
    PredictedView add_predict(graph::FrameGraph& graph, const VoxelMapIds& voxels, const VisibleBlocks& visible,
                              const RaycastImages& cast, const OtherLights* other = nullptr);
    /// The same, whose glossy surfaces mirror what is around where settings say so. `ball_m`: the camera's centre in
    /// the world, and how far from it the map is looked at.
    PredictedView add_predict_mirrors(graph::FrameGraph& graph, const VoxelMapIds& voxels, const VisibleBlocks& visible,
                                      const RaycastImages& cast, glm::vec4 ball_m);

    /// The same with the kd that rgb is made with (PredictRadianceInputs::of_picture), for whoever takes a picture
    /// apart into its diffuse part and highlights. It does not depend on when views were predicted.
    PredictedImages add_predict_picture(graph::FrameGraph& graph, const VoxelMapIds& voxels,
                                        const VisibleBlocks& visible, const RaycastImages& cast);

    /// How well it is known what a camera sees; `predicted` is of the same view (shading/sample_coverage.h).
    graph::ImageId add_coverage(graph::FrameGraph& graph, const VisibleBlocks& visible,
                                const PredictedImages& predicted, graph::ImageId position_m) const;

    /// What is known of each segment.
    SegmentIds add_segments(graph::FrameGraph& graph);

    /// What is known of points of the surface: gpu::SampledReflectance[points]; see add_sample_reflectance.
    graph::BufferId add_sample(graph::FrameGraph& graph, graph::BufferId positions_m, graph::BufferId normals,
                               uint32_t points);

    void visit(graph::StateVisitor& visitor);

    std::vector<VoxelMap::PoolBytes> memory() const;
    const ReflectanceStageSettings& settings() const { return settings_; }
    const Lights& lights() const { return lights_; }
    bool gathers() const { return settings_.refine.gathered_rays > 0; }

  private:
    PredictedView predict(graph::FrameGraph& graph, const VoxelMapIds& voxels, const VisibleBlocks& visible,
                          const RaycastImages& cast, const OtherLights* other, PredictRadianceInputs inputs);
    graph::BufferId add_average(graph::FrameGraph& graph, const ObservationMapIds& records) const;
    ReflectanceModels models(const RefinedPart& part) {
        return {map_, observations_, lights_, materials_, state_, part};
    }

    const VoxelMap& map_;
    ReflectanceStageSettings settings_;
    ObservationMap observations_;
    Lights lights_;
    SegmentMaterials materials_;
    ReflectanceState state_;
    std::vector<gpu::Camera> low_exposure_cameras_;
    AwayAlbedo away_;
    bool any_left_ = false;    ///< records, since the map was reset
    uint64_t reclaim_at_ = 0;  ///< the frame from which on that is due
    uint32_t reclaim_turn_ = 0;
    bool relit_ = false;   ///< under lights that no frame showed
    bool shared_ = false;  ///< no record changed since they told each other of their albedo
    ReflectanceAccess access_;
};

}  // namespace patina
