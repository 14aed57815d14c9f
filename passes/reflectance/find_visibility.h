#pragma once

#include "passes/reflectance/find_due_records.h"

namespace patina {

/// Finds which lights reach the records of due.march, by marching through the TSDF from above the record's surface
/// towards each light: a bit per light in the map's visibility, and one in the status where the ray passes a surface
/// within about a voxel, or leaves its own at less than some 7 degrees. Space that was never seen is open; a lamp does
/// not stand in its own way. Without params.shadows all bits are set. Records whose visibility changed join due.refine.
void add_find_visibility(graph::FrameGraph& frame, ReflectanceFrame& reflectance, DueRecords& due);

}  // namespace patina
