#pragma once

#include "engine/graph/runner.h"
#include "passes/reflectance_model.h"
#include "passes/surface/mesh.h"
#include "passes/surface/mesh_reflectance.h"

namespace patina {

/// What the vertices of a mesh reflect, and all segments; waits for the device. At most `batch_points` vertices (above
/// 0) are sampled at once, which changes nothing about the result. Throws Error when memory runs out.
MeshReflectance sample_mesh(graph::Runner& runner, ReflectanceModel& model, const Mesh& mesh,
                            uint32_t batch_points = 1u << 20);

}  // namespace patina
