#pragma once

#include "passes/reflectance/find_due_records.h"

namespace patina {

/// Gives the records of `march` the light that refinement, the fit of gloss and re-rendering count with,
/// RecordStatus::incident: the mean over what a record and those beside it gathered (gather_irradiance.h), up to 9 of
/// one surface, weighted by their rays. Irradiance changes slowly over a surface, and the noise of few
/// rays does not. It counts as so many rays as it is worth by how far these records differ, no more than there are.
void add_smooth_irradiance(graph::FrameGraph& frame, ReflectanceFrame& reflectance, const RecordList& march);

}  // namespace patina
