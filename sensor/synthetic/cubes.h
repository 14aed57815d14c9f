#pragma once

#include "sensor/synthetic/scene.h"

namespace patina::sensor {

/// The scene `cubes` (paper, Section 4.2): cubes of 0.4 m edge on a floor, each of its own material, turned, stacked,
/// balanced on an edge and on a corner, none touching more than what it stands on. The camera oscillates 4 m from the
/// centre around it. Three point lights stand around the cubes, so that every side seen gets light.
Scene make_cubes();

}  // namespace patina::sensor
