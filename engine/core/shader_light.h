#pragma once

#include "patina/lighting.h"
#include "shared/lighting/lights.h"

namespace patina {

/// A lamp, as shaders take it: rounded to float.
gpu::PointLight make_point_light(const Light& light);

/// A lamp that a shader found.
Light light_of(const gpu::PointLight& light);

/// A lamp with the values that shaders compute with.
Light rounded_to_float(const Light& light);

}  // namespace patina
