#pragma once

#include <optional>
#include <string>

#include "passes/state/network.h"
#include "patina/session.h"
#include "reconstruction/pipeline.h"

namespace patina {

/// The network that estimates materials as the options say; none where they ask for none, or leave it open and none
/// ships. Throws Error when one is asked for that is not there, or as read_network_file.
std::optional<NetworkDescription> read_network(const SessionOptions& options);

/// Sets how specular materials of segments are estimated, as the options say: not at all without lights or segments, or
/// where the materials are given.
void set_specular(ReconstructionSettings& settings, const SessionOptions& options,
                  std::optional<NetworkDescription> network);

/// For run.json: "off", "fit", "hemicnn" or "both".
std::string specular_mode(const ReconstructionSettings& settings);

}  // namespace patina
