#pragma once

#include "engine/graph/runner.h"
#include "patina/scene.h"
#include "reconstruction/stages/reflectance_stage.h"

namespace patina {

/// What the vertices of a mesh reflect, and all segments; waits for the device. At most `batch_points` vertices (above
/// 0) are sampled at once, which changes nothing about the result. Throws Error when memory runs out.
MeshReflectance sample_mesh(graph::Runner& runner, ReflectanceStage& model, const Mesh& mesh,
                            uint32_t batch_points = 1u << 20);

}  // namespace patina
