#pragma once

#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "patina/session.h"
#include "reconstruction/session/detail.h"
#include "sensor/inspect.h"
#include "sensor/look_ahead_source.h"
#include "sensor/recording/recording_source.h"

namespace patina {

/// What the first frames of a recording show before the work starts.
struct Preflight {
    glm::dvec3 world_offset_m{0};       ///< what is taken from all positions: sensor::world_offset_m
    std::vector<std::string> warnings;  ///< of sensor::inspect, about these frames
    DetailChoice detail;                ///< what they suggest, where the options leave it open
};

/// Whether the conventions of a recording's poses matter to a session: all but the first go unused where it tracks.
sensor::ConventionCheck convention_check(const SessionOptions& options);

/// Looks at the first frames of options.sequence, which `source` reads, and on to the first pose where it has any;
/// beyond a second of video that opens the sequence anew. Throws Error when none of its depth readings lies as near as
/// surfaces are fused; to be sure of that, all frames are read.
Preflight look_ahead(sensor::LookAheadSource& source, const SessionOptions& options,
                     const sensor::MakePayloadDecoder& make_decoder = {});

/// Where the world of a recording is moved by: as look_ahead(), without its checks. 0 where no frame has a pose.
glm::dvec3 world_offset_of(const std::string& sequence, const std::string& format,
                           const sensor::MakePayloadDecoder& make_decoder = {});

}  // namespace patina
