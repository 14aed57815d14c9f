#pragma once

#include "reconstruction/session/find_lights.h"

namespace patina::tools {

/// Prints lamps and ambient light, a line each.
void print_lights(const Illumination& illumination);

}  // namespace patina::tools
