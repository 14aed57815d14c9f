#pragma once

#include "passes/input/input.h"
#include "passes/texture/blend_picture.h"
#include "patina/frame.h"
#include "reconstruction/stages/stages.h"

namespace patina {

/// A colour picture of what was reconstructed.
struct TexturePicture {
    ColorInput color;
    RigidTransform world_from_camera{1.0};
    glm::vec3 gain{1};  ///< of its colours over those of the first frame
};

/// Of the model as a picture's camera sees it: at most 640 pixels along a side. Light, shadows and highlights change
/// slowly.
Extent2D cast_extent(Extent2D picture);

/// The picture on the device, and the model as its camera sees it, of cast_extent(). What the camera sees of the model
/// must be on the device. `depth_m`: where the depth goes; empty: into a transient image. Throws Error as
/// add_convert_color does.
BlendPictureInputs add_cast_picture(graph::FrameGraph& graph, Stages& stages, const TexturePicture& picture,
                                    std::optional<graph::ImageId> depth_m = std::nullopt);

}  // namespace patina
