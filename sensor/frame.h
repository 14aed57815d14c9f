#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>

#include <glm/glm.hpp>

#include "engine/core/camera.h"
#include "engine/core/image.h"

namespace patina::sensor {

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

/// One RGB-D frame. `index` counts the sequence's frames from 0, frames without a usable picture included.
struct Frame {
    uint32_t index = 0;
    double timestamp_s = 0;
    ColorImage color;
    DepthImage depth;
    std::optional<RigidTransform> world_from_camera;  ///< of the depth camera; empty where the sequence has no pose
    double pose_defect = 0;  ///< rotation_defect of the pose as recorded; readers repair small ones
    Exposure exposure;
};

/// What holds for a whole sequence.
struct SequenceInfo {
    std::string name;
    std::string format;  ///< "patina-sequence", "7-scenes", "tum", "open3d", "synthetic"
    double fps = 30;
    uint32_t frames = 0;
    Intrinsics color;
    Intrinsics depth;
    double metres_per_unit = 0.001;  ///< of integer depth pictures
    double max_metres = 8;           ///< farther readings are not to be used
    RigidTransform color_from_depth{1.0};
    bool has_poses = false;
    bool exposure_known = false;  ///< frames tell their exposure; else the camera may have changed it, and its white
                                  ///< balance, by itself
    bool motion_blur = true;      ///< colour pictures blur where the camera moves; false: each is of one instant, as
                                  ///< those of a synthetic scene are
};

}  // namespace patina::sensor
