#pragma once

#include <optional>
#include <vector>

#include <glm/glm.hpp>

namespace patina::reference {

/// A linear colour at a voxel.
struct ColoredVoxel {
    glm::dvec3 color{0};
    glm::ivec3 voxel{0};
};

/// How colours fall into two.
struct ColorSplit {
    glm::dvec2 axis{0};  ///< of unit length, in the plane of r and g over r + g + b, toward the fewer
    double threshold = 0;
    double apart = 0;    ///< between the means of the two
    double between = 0;  ///< share of all in the middle half of what is between the two means
    double mixed = 0;    ///< share of those whose nearest neighbour is of the other colour, over that by chance
    size_t fewer = 0;    ///< of the rarer colour
};

/// The best two parts of the colours' chromaticities along their principal axis (Otsu 1979), whatever they are worth;
/// black voxels count for nothing. None without two different ones.
std::optional<ColorSplit> best_color_split(const std::vector<ColoredVoxel>& voxels);

/// Whether a colour is that of the fewer.
bool is_of_fewer(const ColorSplit& split, glm::dvec3 color);

}  // namespace patina::reference
