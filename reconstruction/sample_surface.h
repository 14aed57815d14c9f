#pragma once

#include <cstdint>
#include <vector>

#include "engine/graph/runner.h"
#include "patina/scene.h"
#include "reconstruction/stages/reflectance_stage.h"

namespace patina {

/// What all segments reflect, by label, but for how sure their gloss is; waits for the device.
std::vector<SegmentReflectance> read_segments(graph::Runner& runner, ReflectanceStage& model);

/// What the vertices of a mesh reflect, without the segments; waits for the device. At most `batch_points` vertices
/// (above 0) are sampled at once, which changes nothing about the result. Throws Error when memory runs out.
MeshReflectance sample_vertices(graph::Runner& runner, ReflectanceStage& model, const Mesh& mesh,
                                uint32_t batch_points = 1u << 20);

}  // namespace patina
