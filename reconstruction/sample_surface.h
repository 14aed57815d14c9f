#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "engine/graph/runner.h"
#include "patina/scene.h"
#include "reconstruction/stages/reflectance_stage.h"
#include "reconstruction/streaming/stream_region.h"

namespace patina {

/// What all segments reflect, by label, but for how sure their gloss is; waits for the device.
std::vector<SegmentReflectance> read_segments(graph::Runner& runner, ReflectanceStage& model);

/// What arrives from where there is no surface, as Scene::far_field has it; waits for the device. Empty where no light
/// is gathered.
Image<glm::vec4> read_far_field(graph::Runner& runner, const ReflectanceStage& model);

/// The windows that pictures showed beside these lamps (find_windows.h); waits for the device. None where no light is
/// gathered.
std::vector<AreaLight> read_windows(graph::Runner& runner, const ReflectanceStage& model, glm::dvec3 inside_m,
                                    std::span<const Light> lamps);

/// What the vertices of a mesh reflect, without the segments; waits for the device. At most `batch_points` vertices
/// (above 0) are sampled at once, which changes nothing about the result. Throws Error when memory runs out.
MeshReflectance sample_vertices(graph::Runner& runner, ReflectanceStage& model, const Mesh& mesh,
                                uint32_t batch_points = 1u << 20);

/// The same where records may be away: vertices are taken cube by cube, once `bring` has brought the records of the
/// blocks of a region to the device. Where it returns false, as there are too many, smaller cubes are tried. `block_m`:
/// edge of a block.
using BringRecords = std::function<bool(const StreamRegion&)>;
MeshReflectance sample_cube_by_cube(graph::Runner& runner, ReflectanceStage& model, const Mesh& mesh, double block_m,
                                    const BringRecords& bring);

}  // namespace patina
