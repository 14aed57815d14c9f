#pragma once

#include <array>
#include <optional>
#include <vector>

#include <glm/glm.hpp>

#include "patina/camera.h"
#include "patina/image.h"

namespace patina::reference {

/// A triangle of a surface in the page of a texture.
struct PlacedTriangle {
    std::array<glm::dvec3, 3> positions_m, normals, kd;
    std::array<glm::dvec2, 3> places_px;
};

/// The surface at a texel.
struct PlacedTexel {
    glm::dvec3 position_m, normal, kd;
    double distance_px = 0;  ///< of the texel's centre from the triangle
};

/// What add_place_texels finds for the texel in a column and a row of the page.
std::optional<PlacedTexel> place_texel(const std::vector<PlacedTriangle>& triangles, uint32_t column, uint32_t row);

/// A picture, and the model as its camera sees it.
struct BakePicture {
    Intrinsics camera;
    RigidTransform world_from_camera{1.0};
    Image<glm::dvec4> color;                       ///< a: 1 valid, 0.5 clipped, 0 invalid
    Image<glm::dvec4> position_m, kd, rgb, light;  ///< cast, of any extent
    bool reflects = true;
    glm::dvec3 gain{1};
    double voxel_m = 0.005;
};

/// What a picture says of a texel: weighted albedo, and the weight; 0 where it does not see it (add_blend_picture).
glm::dvec4 blend_picture(const BakePicture& picture, const glm::dvec3& position_m, const glm::dvec3& normal);

}  // namespace patina::reference
