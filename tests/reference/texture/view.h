#pragma once

#include <vector>

#include "tests/reference/texture/bake.h"

namespace patina::reference {

/// What add_albedo_picture makes of a picture: the albedo; a: 1 where it is told, 0.5 where it is shown alone, else 0.
Image<glm::dvec4> albedo_picture(const BakePicture& picture);

/// What a picture of albedos says of a surface point to who looks from `eye_m` (add_blend_picture_for).
struct SaidToEye {
    glm::dvec4 told{0}, shown{0};  ///< weighted albedo, and the weight
};
SaidToEye blend_picture_for(const BakePicture& picture, const Image<glm::dvec4>& albedo, const glm::dvec3& position_m,
                            const glm::dvec3& normal, const glm::dvec3& eye_m);

/// A pixel of a view with what pictures say of it.
struct ViewPixel {
    bool surface = false;
    glm::dvec3 position_m{0}, normal{0};
    SaidToEye said;
};

/// The mean of what pictures tell, or show, of each pixel: of those up to three pixels away on the same surface where
/// there is none of its own. a: 0 where there is none at all (add_show_texels).
std::vector<glm::dvec4> means_of(const std::vector<ViewPixel>& view, Extent2D extent, bool told);

}  // namespace patina::reference
