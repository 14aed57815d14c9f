#pragma once

#include <string>
#include <vector>

#include "tools/outcome.h"
#include "tools/sequence_fusion.h"

namespace patina::tools {

/// Adds what a fused sequence falls short of: what full pools refused, frames that could not be used (more than a
/// tenth), tracking that was lost and not found again, lights that were looked for in vain. Call it after fuse_all()
/// has returned or thrown.
void note_shortfalls(SequenceFusion& fusion, Outcome& outcome);

/// What full pools refused, one sentence each; what to raise.
std::vector<std::string> refusals(SequenceFusion& fusion);

/// What else a user should know of a fused sequence.
std::vector<std::string> warnings(SequenceFusion& fusion);

/// Says from which frame on tracking was lost for good; empty where the last frames track, or poses are given.
std::string lost_for_good(const std::vector<TrackedFrame>& tracked);

}  // namespace patina::tools
