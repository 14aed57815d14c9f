#pragma once

#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "tools/sequence_fusion.h"

namespace patina::tools {

/// What the first frames of a recording show before the work starts.
struct Preflight {
    glm::dvec3 world_offset_m{0};       ///< what is taken from all positions: sensor::world_offset_m
    std::vector<std::string> warnings;  ///< of sensor::inspect, about these frames
};

/// Whether the conventions of a recording's poses matter to a run: all but the first go unused where it tracks.
sensor::ConventionCheck convention_check(const SequenceOptions& options);

/// Looks at the first frames of a recording, and on to the first pose where it has any. Throws Error when it cannot be
/// opened, or when none of its depth readings lies as near as surfaces are fused; to be sure of that, all frames are
/// read.
Preflight look_ahead(const SequenceOptions& options);

/// Where the world of a recording is moved by: as look_ahead(), without its checks. 0 where no frame has a pose.
glm::dvec3 world_offset_of(const std::string& sequence, const std::string& format);

}  // namespace patina::tools
