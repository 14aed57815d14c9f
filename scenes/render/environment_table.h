#pragma once

#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "patina/image.h"
#include "shared/scenes/environment.h"

namespace patina::scenes {

/// An environment's picture, prepared to be drawn from: pixels row by row, each a cell of the sphere of directions that
/// shines evenly.
struct EnvironmentTable {
    Extent2D extent;
    std::vector<glm::vec4> cells;                ///< rgb: radiance; w: density of a drawn direction, per steradian
    std::vector<gpu::EnvironmentAlias> aliases;  ///< Walker's alias method: draws cell i, or aliases[i].other instead
};

/// The share of the sphere, in steradians, of each cell of a picture's row.
double cell_solid_angle(Extent2D extent, uint32_t row);

/// Prepares a latitude-longitude picture so that a cell is drawn in proportion to its radiance, summed over the
/// channels, times its solid angle; all of them alike in proportion to their solid angles when the picture is black.
/// Throws Error naming the scene and the pixel whose radiance is negative or not finite, or for a picture that is empty
/// or has more than 2^23 pixels, what a portable storage buffer holds.
EnvironmentTable make_environment_table(const std::string& scene_name, const Image<glm::vec3>& radiance);

}  // namespace patina::scenes
