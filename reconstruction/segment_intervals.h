#pragma once

#include <vector>

#include "engine/graph/runner.h"
#include "patina/scene.h"
#include "reconstruction/stages/reflectance_stage.h"
#include "reconstruction/stages/specular_stage.h"

namespace patina {

/// Adds to segments, by label, how sure their gloss is, and, where it is fitted, the intervals of their materials;
/// waits for the device. A fitted gloss is as sure as its intervals are narrow, and never surer than the fit is of it.
/// Throws Error when memory runs out.
void add_intervals(graph::Runner& runner, ReflectanceStage& reflectance, const SpecularStage& specular,
                   std::vector<SegmentReflectance>& segments);

}  // namespace patina
