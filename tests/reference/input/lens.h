#pragma once

#include <optional>

#include "patina/camera.h"

namespace patina::reference {

/// Where the distorted picture shows what the pinhole camera shows at pixel (x, y); empty where that is outside.
std::optional<glm::dvec2> find_source(const Intrinsics& camera, uint32_t x, uint32_t y);

}  // namespace patina::reference
