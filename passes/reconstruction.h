#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/graph/runner.h"
#include "passes/color_correction.h"
#include "passes/fusion/allocate_blocks.h"
#include "passes/fusion/raycast.h"
#include "passes/growing_pools.h"
#include "passes/input/input.h"
#include "passes/keyframe_model.h"
#include "passes/model/voxel_map.h"
#include "passes/reflectance_model.h"
#include "passes/segmentation_model.h"
#include "passes/specular_model.h"
#include "passes/surface/mesh.h"
#include "passes/surface/mesh_reflectance.h"
#include "passes/tracking_model.h"

namespace patina {

/// All settings of a reconstruction; plain values, echoed whole in run.json.
struct ReconstructionSettings {
    VoxelMapSettings map;
    FusionSettings fusion;
    InputSettings input;
    float near_m = 0.1f;         ///< nothing nearer to a camera is cast
    uint32_t remove_every = 16;  ///< blocks without surface are removed every so many frames; 0 keeps them
    /// Estimates each frame's colour gains, for cameras that change exposure or white balance by themselves; empty:
    /// colours are taken as they are. Needs fusion.color.
    std::optional<GainSettings> gains{};
    /// Observations and albedo beside the geometry; empty: none. Needs lights (Reconstruction::reflectance).
    std::optional<ReflectanceModelSettings> reflectance{};
    /// Segments of the map; empty: none.
    std::optional<SegmentationSettings> segmentation{};
    /// Specular materials of the segments; empty: those that the reflectance was given. Needs both of the former.
    std::optional<SpecularSettings> specular{};
    std::optional<NetworkDescription> network{};  ///< that estimates specular materials; empty: none
    /// Finds the frames' poses; empty: they are given.
    std::optional<TrackingSettings> tracking{};
    /// Keyframes of what is fused, by which a camera that tracking lost is found again; empty: none.
    std::optional<KeyframeSettings> keyframes{};
    /// Of all that is drawn at random: ferns of keyframes, the records that stand for a segment, those that the network
    /// is shown, the samples that lights are fitted to, and how fused colours are rounded. Each of these has a seed of
    /// its own, which this one changes; 0 leaves it.
    uint64_t seed = 0;
    bool view_every_frame = false;  ///< cast the model into every depth frame, as a live view or a tracker needs it
};

/// How full the pools of the observations are.
struct ObservationCounters {
    gpu::MapCounters blocks{};
    gpu::MapCounters records{};  ///< their block is a voxel's record
};

/// One RGB-D frame with its pose. The pixels are read within add().
struct RgbdFrame {
    DepthInput depth;
    ColorInput color;
    RigidTransform color_from_depth{1.0};
    /// Pose of the depth camera. With tracking: of the first frame alone, whose world it chooses.
    RigidTransform world_from_depth{1.0};
    FrameTime time{};  ///< for tracking alone
    /// What each pixel of the depth picture belongs to, 0: unknown; empty: no labels are known. Used where the
    /// settings say that segments are given.
    std::span<const uint16_t> labels{};
    /// Of the time since the frame before, the share in which the colour camera's shutter was open; 0: its pictures are
    /// not blurred by motion.
    float shutter_share = 0;
    bool held_out = false;  ///< its colours are neither fused nor observed, its depth is fused
};

/// Poses (world_from_depth) at which a frame may have been taken, the likeliest first, found by other means than
/// tracking.
using Relocaliser = std::function<std::vector<RigidTransform>(const RgbdFrame&)>;

/// What a camera sees of the model; all pictures have its extent.
struct ModelView {
    Image<glm::vec4> position_m;  ///< world; w: depth along the optical axis, 0 where nothing was hit
    Image<glm::vec4> normal;      ///< world, unit length; 0 where nothing was hit
    Image<glm::vec4> color;       ///< linear; a = 0 where there is none
    Image<uint32_t> label{};      ///< segment of the map, 0: none; empty without segmentation

    /// What the model reflects, where it has reflectance (shading/predict_radiance.h).
    struct Reflectance {
        Image<glm::vec4> kd;                               ///< diffuse albedo; a = 1 where it is known
        Image<glm::vec4> ks_alpha;                         ///< of the segment
        Image<uint32_t> label;                             ///< 0: none
        Image<glm::vec4> rgb;                              ///< linear re-rendering; a = 1 where kd is known
        Image<glm::vec4> light;                            ///< what kd multiplies in rgb; a: the part shadows leave
        std::vector<std::optional<glm::vec3>> segment_kd;  ///< by label: the mean albedo of the whole segment
    };
    std::optional<Reflectance> reflectance{};
};

/// A view on its way from the device.
class PendingView {
  public:
    bool ready() const { return color_.ready(); }
    /// Throws Error before it is ready.
    ModelView get() const;

  private:
    friend class Reconstruction;
    struct Reflectance {
        graph::Readback kd, ks_alpha, label, rgb, light, segments;
    };
    graph::Readback position_m_, normal_, color_;
    std::optional<graph::Readback> label_;
    std::optional<Reflectance> reflectance_;
};

/// Fuses RGB-D frames into a volume and extracts its surface. Frames are submitted without waiting for the device, two
/// in flight. One device, one thread.
class Reconstruction {
  public:
    /// Throws Error for settings that cannot be met, or lack of memory.
    Reconstruction(vulkan::Device& device, const ReconstructionSettings& settings);

    /// Fuses a frame. The first one places the volume around its camera. With tracking its pose is found first: one
    /// graph fuses the frame before, casts the model and searches, and its end is waited for; the frame itself, whose
    /// pictures stay on the device, is fused by the next one's graph, or as soon as anything is asked of the model.
    /// Returns whether the frame is fused: without tracking all are, with it those that track. Throws Error when a
    /// picture is not its camera's size, or the device was lost.
    bool add(const RgbdFrame& frame);

    /// Fuses a frame at its given pose although others are tracked; tracking goes on from there.
    void add_posed(const RgbdFrame& frame);

    /// Asks `relocaliser` for poses of every frame that tracking lost, instead of the keyframes; the first from which
    /// the frame tracks is taken.
    void set_relocaliser(Relocaliser relocaliser) { relocaliser_ = std::move(relocaliser); }

    /// The keyframes' counters; waits. Zero without keyframes.
    gpu::KeyframeCounters keyframe_counters();
    /// Null when the settings have none.
    const KeyframeModel* keyframes() const { return keyframes_ ? &*keyframes_ : nullptr; }

    /// How the last frame was tracked, and from where it was taken; null where poses are given.
    const TrackingReport* tracking_report() const { return tracking_ ? &tracking_->last() : nullptr; }
    const TrackingModel* tracking() const { return tracking_ ? &*tracking_ : nullptr; }

    /// Casts the model into a pinhole camera (lens distortion is left out). Ready two frames later, or after wait().
    PendingView view(const Intrinsics& camera, const RigidTransform& world_from_camera);

    /// How far surfaces are fused and seen, metres along the optical axis of a depth camera: fusion.max_depth_m, or
    /// less, where with such small voxels the view of the map does not reach so far (view_reach_m).
    float reach_m(const Intrinsics& camera) const;

    /// Fuses what waits to be, and waits for the device.
    void wait();

    /// Extracts the surface from what was fused so far; waits.
    Mesh extract_surface();

    /// What a mesh of the surface and all segments reflect, brought up to date before; waits. Empty without
    /// reflectance.
    MeshReflectance sample_reflectance(const Mesh& mesh);

    // With tracking, none of what follows tells of the last frame before wait(); runner().wait() does not fuse it.

    /// The map's counters as of at most two frames ago; exact after wait().
    const gpu::MapCounters& counters();

    /// The observations' counters, likewise; zero without reflectance.
    const ObservationCounters& observation_counters();

    /// How full the pools are, and what keeps them from growing; waits.
    std::vector<PoolState> pools();
    /// The same as of two frames ago; does not wait.
    std::vector<PoolState> recent_pools() const { return pools_->states(); }

    /// How many blocks the depth camera saw in the frame that counters() tells of.
    uint32_t visible_blocks();

    /// Brings all of the reflectance up to date, where there is any; else that is spread over frames.
    void refine_all();

    /// The segments' counters as of at most two frames ago; exact after wait(). Zero without segmentation.
    const gpu::SegmentCounters& segment_counters();

    /// How steady the segments' labels were in the frames that segment_counters() tells of.
    const LabelStability& label_stability();

    /// The segments of the map; null when the settings have none.
    const SegmentationModel* segmentation() const { return segmentation_ ? &*segmentation_ : nullptr; }

    /// The specular materials of the segments; null when the settings have none.
    const SpecularModel* specular() const { return specular_ ? &*specular_ : nullptr; }

    /// Puts the model under other lights than those of its frames, for views alone: no frame may be added after that.
    /// Brings the reflectance up to date first.
    /// Without reflectance nothing changes. Throws Error as Lights::set does.
    void relight(std::span<const PointLight> lights, glm::vec3 ambient = glm::vec3(0));

    /// The reflectance beside the geometry; null when the settings have none. Its lights and materials may change at
    /// any time.
    ReflectanceModel* reflectance() { return reflectance_ ? &*reflectance_ : nullptr; }

    /// The colour gains of the frames so far (ColorCorrection::gains); empty where the settings estimate none.
    std::span<const gpu::ColorGains> gains() {
        return color_correction_ ? std::span(color_correction_->gains()) : std::span<const gpu::ColorGains>();
    }

    uint32_t frames() const { return frames_ + (waiting_ ? 1 : 0); }
    const ReconstructionSettings& settings() const { return settings_; }
    const VoxelMap& map() const { return map_; }
    graph::Runner& runner() { return runner_; }

  private:
    struct PendingCounts {
        PoolReadbacks pools;
        graph::Readback visible_blocks;
    };

    TrackingReport start_tracking(const RgbdFrame& frame);
    TrackingReport track(const RgbdFrame& frame);
    TrackingReport best_search(const RgbdFrame& frame);
    TrackingReport search(graph::Frame graph, const InputPictures& pictures, const RgbdFrame& frame,
                          const RigidTransform& start);
    TrackingReport search_again(const RgbdFrame& frame, const RigidTransform& start);
    std::optional<TrackingReport> relocalised(const RgbdFrame& frame);
    std::vector<RigidTransform> candidates(const RgbdFrame& frame);
    TrackingReport search_from(const RgbdFrame& frame, const RigidTransform& start);
    void cast_reference(const Intrinsics& camera, const RigidTransform& world_from_depth);
    void keep_reference(graph::Frame& graph, const VoxelMapIds& ids, const VisibleBlocks& visible,
                        const RaycastImages& model, const Intrinsics& camera, const RigidTransform& world_from_depth);
    float far_m() const;
    void start_map(const RgbdFrame& frame);
    graph::Frame begin_fusing();
    void fuse_first(const RgbdFrame& frame);
    PendingCounts submit_posed(graph::Frame graph, const RgbdFrame& frame);
    void submit_fusion(graph::Frame graph, const PendingCounts& counts);
    void fuse_posed(const RgbdFrame& frame);
    void fuse_waiting();
    PendingCounts add_waiting(graph::Frame& graph);
    void note_waiting_fused(PendingCounts counts);
    PendingCounts add_fusion(graph::Frame& graph, const RgbdFrame& frame, const InputPictures& pictures);
    VisibleBlocks add_passes(graph::Frame& graph, VoxelMapIds& ids, const RgbdFrame& frame,
                             const InputPictures& pictures);
    void note_fused(const RgbdFrame& frame, PendingCounts counts);
    bool fuses_color(const RgbdFrame& frame) const { return settings_.fusion.color && !frame.held_out; }
    RaycastImages sharpened(graph::Frame& graph, const RaycastImages& model, const Intrinsics& camera) const;
    graph::ImageId segment(graph::Frame& graph, const VoxelMapIds& ids, const VisibleBlocks& visible,
                           const RaycastImages& model, const InputImages& input, const RgbdFrame& frame);
    void observe(graph::Frame& graph, const VoxelMapIds& ids, ObservationInputs inputs, const RgbdFrame& frame);
    void check(const RgbdFrame& frame) const;
    void take_counts();

    ReconstructionSettings settings_;
    graph::Runner runner_;
    VoxelMap map_;
    MapAccess access_;
    std::optional<ColorCorrection> color_correction_;
    std::optional<ReflectanceModel> reflectance_;
    std::optional<SegmentationModel> segmentation_;
    std::optional<SpecularModel> specular_;
    std::optional<TrackingModel> tracking_;
    std::optional<KeyframeModel> keyframes_;
    std::optional<GrowingPools> pools_;
    Relocaliser relocaliser_;
    struct Waiting {
        RgbdFrame frame;  ///< with its pose; its pictures are in tracking_->pictures()
        std::vector<uint16_t> labels;
    };
    std::optional<Waiting> waiting_;                         ///< to be fused
    uint32_t weak_frames_ = 0;                               ///< the last ones
    std::optional<RigidTransform> world_from_color_before_;  ///< of the last frame
    uint32_t frames_ = 0;
    uint32_t color_frames_ = 0;  ///< of these, whose colour was fused
    std::deque<PendingCounts> pending_counts_;
    gpu::MapCounters counters_{};
    ObservationCounters observation_counters_;
    uint32_t visible_blocks_ = 0;
    gpu::SegmentCounters segment_counters_{};
    LabelStability label_stability_;
};

}  // namespace patina
