#pragma once

#include <glm/glm.hpp>

#include "reconstruction/session/find_lights.h"

namespace patina {

/// The light of a recording of which no lamp is known: what its surfaces send each other is gathered while they are
/// reconstructed; from where nothing is seen, white light arrives under which bright surfaces of the recording's first
/// frames have SessionOptions::white_albedo (BrightSurfaces). Throws Error when the recording cannot be opened;
/// Interrupted when the user stops it.
Illumination light_of_surroundings(vulkan::Device& device, const SessionOptions& options, glm::dvec3 world_offset_m);

}  // namespace patina
