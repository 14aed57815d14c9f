#pragma once

#include <string>

#include "tools/sequence_fusion.h"

namespace patina::tools {

/// Sets how specular materials of segments are estimated, as the options say: not at all without lights or segments, or
/// where the materials are given. Throws Error when a network is asked for that is not there, or as read_network_file.
void set_specular(ReconstructionSettings& settings, const SequenceOptions& options);

/// For run.json: "off", "fit", "hemicnn" or "both".
std::string specular_mode(const ReconstructionSettings& settings);

}  // namespace patina::tools
