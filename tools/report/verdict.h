#pragma once

#include <string>
#include <vector>

#include "tools/report/run_summary.h"

namespace patina {

/// What a run came to, in sentences for people.
struct Verdict {
    std::vector<std::string> good;     ///< what is known
    std::vector<std::string> unknown;  ///< what is not, and how to scan it
};

/// Judges frames, tracking, colour, albedo, gloss, lamps and held-out pictures.
Verdict verdict_of(const RunSummary& summary);

/// A segment's gloss was estimated, and is more than a guess.
bool gloss_is_observed(const SegmentReflectance& segment);

}  // namespace patina
