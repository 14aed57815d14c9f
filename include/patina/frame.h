#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <variant>

#include <glm/glm.hpp>

#include "patina/camera.h"
#include "patina/image.h"

namespace patina {

/// 8-bit sRGB-encoded pixel; a channel at 255 is clipped.
using SrgbPixel = glm::u8vec3;

/// A colour picture: 8-bit sRGB, or linear radiance as floats.
using ColorImage = std::variant<Image<SrgbPixel>, Image<glm::vec3>>;

/// A depth picture: raw integer units (see SequenceInfo::metres_per_unit), or metres. 0, the format's own invalid value
/// (which readers turn into 0) and non-finite values mean 'no reading'.
using DepthImage = std::variant<Image<uint16_t>, Image<float>>;

/// Exposure of one frame; only ratios between frames and sequences of one camera matter.
struct Exposure {
    double exposure_s = 0.01;
    double gain = 1.0;

    bool operator==(const Exposure&) const = default;
};

/// One RGB-D frame of a source. `index` counts the source's frames from 0, frames without a usable picture included.
struct Frame {
    uint32_t index = 0;
    double timestamp_s = 0;  ///< on the source's own clock; never runs backwards
    ColorImage color;
    DepthImage depth;
    std::optional<RigidTransform> world_from_camera;  ///< of the depth camera; empty where the source has no pose
    double pose_defect = 0;  ///< rotation_defect of the pose as recorded; readers repair small ones
    Exposure exposure;
};

/// What holds for all frames of a source.
struct SequenceInfo {
    std::string name;
    std::string format;  ///< a recording's, as "tum" (docs/guide/recording.md lists all); "synthetic"
    double fps = 30;
    std::optional<uint32_t> frames;  ///< how many there are; empty: the source says when it ends, as a camera does
    Intrinsics color;
    Intrinsics depth;
    double metres_per_unit = 0.001;  ///< of integer depth pictures
    double max_metres = 8;           ///< farther readings are not to be used
    RigidTransform color_from_depth{1.0};
    bool has_poses = false;
    bool exposure_known = false;  ///< frames hold their exposure; else the camera may have changed it, and its white
                                  ///< balance, by itself
    /// Direction in which things fall, in the world of the poses, of any length but 0; empty where it is not recorded.
    std::optional<glm::dvec3> gravity{};
    bool motion_blur = true;     ///< colour pictures blur where the camera moves; false: each is of one instant, as
                                 ///< those of a synthetic scene are
    bool indirect_light = true;  ///< surfaces light each other; false: lamps alone do, as in a synthetic scene without
                                 ///< bounces
};

/// A depth picture as a sensor gave it. The pixels are borrowed.
struct DepthInput {
    /// Rows top to bottom: integer units, or metres. 0, negative and non-finite values mean 'no reading'.
    std::variant<std::span<const uint16_t>, std::span<const float>> pixels;
    Intrinsics camera;
    double metres_per_unit = 0.001;  ///< of integer pixels
    double max_metres = 8;           ///< farther readings are dropped
};

/// A colour picture as a camera gave it. The pixels are borrowed.
struct ColorInput {
    /// Rows top to bottom: 8-bit sRGB, where 255 is clipped, or linear radiance.
    std::variant<std::span<const glm::u8vec3>, std::span<const glm::vec3>> pixels;
    Intrinsics camera;
};

/// When a frame was taken, in seconds on any clock, and where by another tracker's account, whose errors may add up.
struct FrameTime {
    double timestamp_s = 0;
    std::optional<RigidTransform> prior{};
};

/// One RGB-D frame as a reconstruction takes it. Its pixels are read within Reconstruction::add().
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
    bool held_out = false;    ///< its colours are neither fused nor observed, its depth is fused
    bool only_track = false;  ///< its pose is found, where poses are tracked, and nothing of it enters the model
};

}  // namespace patina
