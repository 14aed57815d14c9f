#pragma once

#include <optional>
#include <vector>

#include "passes/state/map_access.h"
#include "passes/state/voxel_map.h"
#include "passes/tracking/judge_motion.h"
#include "passes/tracking/motion_model.h"
#include "passes/tracking/normal_equations.h"
#include "passes/tracking/pack_frame.h"
#include "passes/tracking/pack_model.h"
#include "reconstruction/frame_context.h"
#include "reconstruction/kept_input.h"

namespace patina {

/// How the camera is tracked.
struct TrackingSettings {
    uint32_t levels = 3;             ///< of the pyramids, the finest one the camera's own pixels
    uint32_t finest = 1;             ///< the finest level that is compared; 0: the camera's own pixels
    uint32_t iterations = 4;         ///< on each level
    uint32_t finest_iterations = 4;  ///< on the finest
    bool photometric = true;         ///< compares shades too, where the map has colours
    bool hide_highlights = true;     ///< no shades where the re-rendering is a highlight, where materials are known
    float damping = 0.9f;  ///< of the last motion that is expected to go on; 0: the camera is expected to rest
    TrackErrors errors;
    TrackingBounds bounds;
};

/// Finds the pose of each frame by comparing it with the model as it was cast into a reference camera, the last frame's
/// pose (frame-to-model tracking, Newcombe et al. 2011; the photometric term after Kerl, Sturm and Cremers 2013). Lives
/// as long as the map. Holds three things between frames: on the device the reference and the pictures of the frame
/// that was searched for last, on the host the motion so far.
class TrackingStage {
  public:
    /// Throws Error for settings that cannot be met.
    TrackingStage(vulkan::Device& device, const TrackingSettings& settings);

    /// Keeps what the camera sees of the model from a pose as the reference of the searches to come. Its intrinsics
    /// must stay the same from call to call.
    void add_reference(graph::FrameGraph& graph, const RaycastImages& surface,
                       std::optional<graph::ImageId> color_linear, const PosedCamera& camera);
    bool has_reference() const { return !reference_.empty(); }

    /// One search under way.
    struct Search {
        RigidTransform start{1.0};  ///< world_from_camera
        RigidTransform world_from_reference{1.0};
        graph::Readback state;  ///< gpu::TrackState
    };

    /// The frame's pyramid, the finest level that is made first.
    std::vector<TrackLevel> add_pyramid(graph::FrameGraph& graph, graph::ImageId depth_m, const Intrinsics& camera,
                                        const std::optional<TrackColor>& color, float max_depth_m) const;

    /// Searches for the pose of a frame from a start on: all iterations in this graph, without a wait.
    Search add_search(graph::FrameGraph& graph, const std::vector<TrackLevel>& pyramid,
                      const RigidTransform& start) const;

    /// What a search found, once its frame has finished.
    TrackingReport report_of(const Search& search) const;

    /// Takes over what was found of a frame. `jumped`: it was found elsewhere than the motion so far led to.
    void accept(const TrackingReport& report, const FrameTime& time, bool jumped);

    /// The frame's pictures, which its searches share, and its fusion once its pose is known.
    KeptInput& pictures() { return pictures_; }

    /// Where the camera may be when a frame was taken, the likeliest first. Needs a reference.
    std::vector<RigidTransform> expected(const FrameTime& time) const { return motion_.expected(time); }

    /// The pose from which the reference was cast.
    const RigidTransform& world_from_reference() const { return world_from_reference_; }
    const TrackingSettings& settings() const { return settings_; }
    /// Of the last frame.
    const TrackingReport& last() const { return last_; }
    void visit(graph::StateVisitor& visitor);

    std::vector<VoxelMap::PoolBytes> memory() const;

  private:
    /// The finest level that is made: the camera's own pixels, where these are compared, or half as many each way.
    uint32_t first_level() const { return settings_.finest > 0 ? 1 : 0; }
    void make_reference(const Intrinsics& camera);

    vulkan::Device& device_;
    TrackingSettings settings_;
    KeptInput pictures_;
    struct ReferenceLevel {
        vulkan::ImageRef pixels;  ///< rgba32ui
        Intrinsics camera;
    };
    std::vector<ReferenceLevel> reference_;         ///< from first_level() on
    std::optional<Intrinsics> reference_camera_{};  ///< the depth camera that it was made for
    RigidTransform world_from_reference_{1.0};
    MotionModel motion_;
    TrackingReport last_;
};

}  // namespace patina
