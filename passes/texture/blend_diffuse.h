#pragma once

#include "passes/texture/diffuse_picture.h"

namespace patina {

/// A picture without its highlights, and the model as its camera sees it.
struct BlendDiffuseInputs {
    DiffusePicture picture;
    graph::ImageId depth_m;  ///< r32f: the model cast into the same view, of any extent (add_cast_depth)
    gpu::Camera camera;      ///< of the picture
    float voxel_m = 0;       ///< of the surface
    glm::vec3 eye_m{0};      ///< world: who looks at the texels
};

/// Adds to the sums of a view's texels what a picture tells of their albedo, and to `shown` what leaves them, also
/// where that tells no albedo. A texel counts as in add_blend_picture. Cosine over squared distance counts no more than
/// it does for the eye, and pictures from its direction, within about a degree, count most. What a picture shows beside
/// edges counts from within 2 degrees of that direction alone, and tells no albedo.
ViewTexelIds add_blend_diffuse(graph::FrameGraph& frame, const TextureBand& page, const ViewTexelIds& ids,
                               const BlendDiffuseInputs& inputs);

}  // namespace patina
