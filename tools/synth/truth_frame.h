#pragma once

#include "export/write_exr.h"
#include "scenes/render/synthetic_source.h"

namespace patina::tools {

/// What a synthetic scene's colour camera sees, as truth/frames/NNNNNN.exr holds it. kd_segment is the object's kd, for
/// a texture the mean of its picture; rgb_segment is empty, as truth knows no image before refinement. Lamps are valid,
/// with label 0 and no material.
FrameDump truth_dump(const scenes::SyntheticScene& scene, const scenes::FrameTruth::Seen& seen);

}  // namespace patina::tools
