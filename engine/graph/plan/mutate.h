#pragma once

#include <string>
#include <vector>

#include "engine/graph/plan/plan.h"

namespace patina::graph {

/// Deletes each barrier of `plan` in turn and lists those whose deletion adds nothing to what check() reports, one
/// sentence each. An empty list means that every barrier is needed, and that check() notices each one that is missing.
std::vector<std::string> find_unneeded_barriers(const Description& description, const Plan& plan);

}  // namespace patina::graph
