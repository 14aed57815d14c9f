#pragma once

#include <vector>

#include "engine/graph/runner.h"
#include "tools/bench/filled_records.h"

namespace patina {

/// Enters records 0, 1, ... that add_fill_records wrote into the table of a map that has no others, so that voxels are
/// found. Throws Error when they lie in more blocks than the map holds.
void enter_records(graph::Runner& runner, const ObservationMap& map, const std::vector<FilledRecord>& records);

}  // namespace patina
