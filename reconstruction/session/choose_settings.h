#pragma once

#include <optional>

#include "passes/state/network.h"
#include "patina/session.h"
#include "reconstruction/pipeline.h"
#include "reconstruction/session/find_lights.h"

namespace patina {

/// The settings of a reconstruction as the options say; what they leave open is decided by what its source and its
/// light are. With light, reflectance is estimated; without, there is nothing to estimate it from. Ambient light alone
/// shows nothing of gloss.
ReconstructionSettings choose_settings(const SessionOptions& options, const SequenceInfo& info,
                                       const Illumination& light, std::optional<NetworkDescription> network);

/// The same of a reconstruction that is given its frames one by one. Throws Error for materials of the truth, which
/// frames do not have, and as read_network().
ReconstructionSettings choose_settings(const ReconstructionOptions& options);

}  // namespace patina
