#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <glm/glm.hpp>

#include "patina/image.h"

namespace patina::scenes {

/// What a procedural picture shows. u runs to the right, v down; "across" is along u.
enum class Pattern {
    kChecker,  ///< cells in the colours' order along rows and columns
    kStripes,  ///< count.x stripes along v, in the colours' order
    kDots,     ///< colours: ground, then the dots'; one dot per cell
    kWeave,    ///< count.x threads along v of the first colour, count.y along u of the second, over and under
    kWood,     ///< count.x planks along v; colours: light wood, its grain, the gaps
    kMarble,   ///< count.x veins across and count.y down; colours: stone, vein
    kNoise,    ///< blotches of about 1 / count; the colours' mix
    kBricks,   ///< rows shifted by half a brick; colours: mortar, then the bricks'
    kTiles,    ///< as bricks, the rows in line
    kBooks,    ///< count.y rows of count.x spines; colours: the gaps, then the spines'
    kText,     ///< count.y lines of about count.x words; colours: paper, then ink
    kKeys,     ///< blocks with rounded corners, some wide; colours: ground, then the keys'
    kPoster,   ///< hills under a sky with a sun, within a margin; colours: margin, sky, sun, then the hills' from afar
};

/// How a procedural picture looks.
struct PatternSettings {
    std::vector<glm::vec3> colors;  ///< linear albedo; their number and meaning depend on the pattern
    glm::uvec2 count{8, 8};         ///< cells along u and v
    uint32_t seed = 0;
    uint32_t size_px = 256;  ///< of the square picture
};

/// The pattern of that name, as "checker". Throws Error that lists all names when there is none.
Pattern pattern_named(std::string_view name);

/// Every pattern's name, in the order of Pattern.
const std::vector<std::string>& pattern_names();

/// Draws a picture of linear albedo in 0 .. 1 that repeats without seams. Detail is at least four texels wide, edges
/// are antialiased. The same settings give the same picture. Throws Error when a colour lies outside 0 .. 1, when there
/// are too few colours, when cells would be narrower than eight texels, or when rows or columns whose colours alternate
/// do not meet their first at the seam.
Image<glm::vec3> draw_pattern(Pattern pattern, const PatternSettings& settings);

/// Reads a PNG or JPEG picture of 8-bit sRGB codes (or OpenEXR, linear) as linear albedo. Throws Error as read_color
/// does, and when an OpenEXR value lies outside 0 .. 1.
Image<glm::vec3> read_texture(const std::filesystem::path& file);

}  // namespace patina::scenes
