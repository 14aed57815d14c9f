#pragma once

#include <string>
#include <vector>

#include "reconstruction/session/session_core.h"

namespace patina {

/// What a fused sequence falls short of, a sentence each: what full pools refused, frames that could not be used (more
/// than a tenth), tracking that was lost and not found again, lights that were looked for in vain.
std::vector<std::string> shortfalls_of(SessionCore& session);

/// What full pools refused, one sentence each; what to raise.
std::vector<std::string> refusals(SessionCore& session);

/// What else a user should know of a fused sequence.
std::vector<std::string> warnings(SessionCore& session);

/// Says from which frame on tracking was lost for good; empty where the last frames track, or poses are given.
std::string lost_for_good(const std::vector<TrackedFrame>& tracked);

}  // namespace patina
