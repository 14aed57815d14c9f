#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "passes/observation/observation_params.h"
#include "patina/frame.h"
#include "reconstruction/streaming/stream_region.h"
#include "shared/input/camera.h"

namespace patina {

/// A pinhole camera at a pose, for the host and for shaders.
struct PosedCamera {
    Intrinsics intrinsics;
    RigidTransform world_from_camera{1.0};
    gpu::Camera gpu{};  ///< both of the above; lens distortion is left out
};

PosedCamera make_posed_camera(const Intrinsics& intrinsics, const RigidTransform& world_from_camera);

/// The same view in pictures of another extent.
PosedCamera resized(const PosedCamera& camera, Extent2D extent);

/// Both cameras of a frame at its pose.
struct FrameCameras {
    PosedCamera depth, color;
};

FrameCameras make_frame_cameras(const RgbdFrame& frame);

/// Which depths count, metres along a camera's optical axis.
struct DepthRange {
    float near_m = 0;   ///< no nearer surface is seen
    float far_m = 0;    ///< no farther surface is seen
    float reach_m = 0;  ///< no farther reading is fused
};

/// What the stages know of one RGB-D frame besides its pictures. Made once a frame, when its pose is known.
struct FrameContext {
    uint32_t index = 0;        ///< how many frames were fused before
    uint32_t preceding = 0;    ///< of these, that precede the recording's own
    uint32_t color_index = 0;  ///< of these, whose colour was fused
    PosedCamera depth;
    PosedCamera color;
    DepthRange range;                      ///< of the depth camera
    std::optional<CameraMotion> motion{};  ///< of the colour camera since the frame before; empty for the first frame
    StreamRegion around{};                 ///< all blocks that the frame's passes look at (GeometryStage::around)
    double shadows_m = 0;                  ///< what lies farther from the depth camera throws no shadow
    bool fuses_color = true;               ///< its colour is fused
    bool held_out = false;                 ///< its colour is neither fused nor observed
    bool precedes = false;                 ///< a frame of low exposure before the first one: Pipeline::add_low_exposure
    std::span<const uint16_t> labels{};    ///< RgbdFrame::labels, borrowed
    /// Of the part of the map whose labels are swept in this frame: voxels that are away from the device, by label.
    std::span<const uint32_t> labels_away{};

    /// Whether no frame of its kind came before it.
    bool first() const { return index == 0 || (index == preceding && !precedes); }

    /// How many pixels of the depth camera apart, in x and y, those are that look for cells of surface to take:
    /// `most_px`, another phase in every frame; but fewer where a picture of few pixels would leave out cells of
    /// `cell_m` on surface that faces it at a usual depth, 3/8 of range.reach_m. Every pixel of the first frame looks.
    uint32_t stride_px(uint32_t most_px, double cell_m) const;
};

/// What the frames so far leave to the next one's context.
struct FrameHistory {
    uint32_t frames = 0;
    uint32_t preceding = 0;                            ///< of these, that precede the recording's own
    uint32_t color_frames = 0;                         ///< of these, whose colour was fused
    std::optional<RigidTransform> world_from_color{};  ///< of the last one

    /// Counts a frame that was fused.
    void note(const FrameContext& frame);
};

/// The context of a frame at its pose, after the frames of `before`. `fuses_color`: the model has colours.
FrameContext make_frame_context(const RgbdFrame& frame, const FrameHistory& before, const DepthRange& range,
                                bool fuses_color);

/// Throws Error when a picture of frame `number` is not its camera's size, or its pose is not rigid.
void check_frame(const RgbdFrame& frame, uint32_t number);

/// Throws Error when a view's camera has no pixels or no focal length, or its pose is not rigid.
void check_view(const Intrinsics& camera, const RigidTransform& world_from_camera);

}  // namespace patina
