#pragma once

#include "passes/reflectance/reflectance_frame.h"

namespace patina {

/// Records whose visibility or albedo may be out of date.
struct DueRecords {
    RecordList march;   ///< whose lights are marched again
    RecordList refine;  ///< whose albedo is computed again
};

/// Lists what is due: records in a window of the table (about params.refreshed of them) that moves on from update to
/// update, so that changes of lights, materials and of the geometry around reach every record: all whose versions are
/// old, and others as `changed` has many or few (gpu::kBusyChanges); and those in
/// `changed`: all for refinement, and for marching those that never were, or whose surface moved since. Where these are
/// more than their budget, hashes that change from update to update say which are taken; the others wait for their next
/// change or for the window. What is listed does not depend on record ids.
DueRecords add_find_due_records(graph::FrameGraph& frame, ReflectanceFrame& reflectance, const RecordList& changed);

}  // namespace patina
