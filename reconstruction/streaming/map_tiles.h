#pragma once

#include <vector>

#include <glm/glm.hpp>

#include "passes/reflectance/reflectance.h"
#include "reconstruction/stages/reflectance_stage.h"
#include "reconstruction/streaming/stream_region.h"

namespace patina {

/// A part of the map that work on all of it takes at once: the records of a cube, and the ball around its centre that
/// the light comes through to them.
struct MapTile {
    RefinedPart part;
    StreamRegion around;  ///< the voxel blocks that reach into the ball
    StreamRegion cube;    ///< the blocks of its records
};

/// Tiles that together hold all records of the blocks, in a fixed order. One, where a ball of `known_m` holds them all
/// with what is around them.
std::vector<MapTile> tiles_of_records(const std::vector<glm::ivec3>& blocks, double block_m, double known_m);

}  // namespace patina
