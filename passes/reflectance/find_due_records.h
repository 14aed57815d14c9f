#pragma once

#include "passes/reflectance/reflectance_frame.h"

namespace patina {

/// Records whose visibility or albedo may be out of date.
struct DueRecords {
    RecordList march;   ///< whose lights are marched again, params.most_marched of them at most, about
    RecordList refine;  ///< whose albedo is computed again
};

/// Lists what is due: of the records in `changed`, and of those in a window of the table that moves on from update to
/// update, so that changes of lights, materials and of the geometry around reach every record. Records wait that were
/// never marched, or whose surface moved since, or that lie in the window, when there are more than params.most_marched
/// of them; which are taken, a range of hashes says that moves on too. Neither depends on record ids.
DueRecords add_find_due_records(graph::Frame& frame, ReflectanceFrame& reflectance, const RecordList& changed);

}  // namespace patina
