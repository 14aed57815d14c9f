#pragma once

#include "patina/reconstruction.h"
#include "reconstruction/pipeline.h"

namespace patina {

/// A pass's samples as three figures; it must have some.
PassTime summarised(const graph::Timing& timing);

/// What the public API shows of a pipeline's counters and pass times; does not wait.
Statistics statistics_of(Pipeline& pipeline);

}  // namespace patina
