#pragma once

#include <vector>

#include "engine/graph/runner.h"
#include "passes/reflectance/reflectance.h"
#include "reconstruction/stages/reflectance_stage.h"
#include "reconstruction/streaming/stream_region.h"

namespace patina {

/// A part of the map that work on all of it takes at once: the records of a cube, and the ball around its centre that
/// the light comes through to them.
struct MapTile {
    RefinedPart part;
    StreamRegion around;  ///< the voxel blocks that reach into the ball
};

/// Tiles that together hold all records of the observations, in a fixed order; waits. One, where a ball of `known_m`
/// holds them all with what is around them.
std::vector<MapTile> tiles_of_records(graph::Runner& runner, const ObservationMap& map, double known_m);

}  // namespace patina
