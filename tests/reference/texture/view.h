#pragma once

#include <vector>

#include "tests/reference/texture/bake.h"

namespace patina::reference {

/// What add_diffuse_picture makes of a picture.
struct DiffusePicture {
    Image<glm::dvec4> diffuse;  ///< a: 1 where it tells the albedo, 0.5 where it is shown alone, 0.25 at edges, else 0
    Image<glm::dvec4> light;
};
DiffusePicture diffuse_picture(const BakePicture& picture);

/// What it says of a surface point to who looks from `eye_m` (add_blend_diffuse).
struct SaidToEye {
    glm::dvec4 told{0}, shown{0};  ///< weighted albedo, and what leaves; a: the weight
};
SaidToEye blend_diffuse(const BakePicture& picture, const DiffusePicture& taken, const glm::dvec3& position_m,
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
