#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include <glm/glm.hpp>

#include "tools/eval/exr_planes.h"
#include "tools/eval/result.h"
#include "tools/eval/segmentation.h"

namespace patina::eval {

/// One object in one frame.
struct ObjectMeasurement {
    uint64_t pixels = 0;
    uint64_t seen_pixels = 0;                       ///< of these, those that were seen often enough
    PerQuantity<std::optional<FramePoint>> points;  ///< empty where the run lacks the quantity or the pixels are few
};

/// What one frame contributes.
struct FrameMeasurement {
    std::map<uint32_t, ObjectMeasurement> objects;  ///< by id
    LabelOverlap overlap;                           ///< empty where the run has no labels
    uint64_t truth_pixels = 0;                      ///< valid in truth
    std::vector<float> depth_errors_mm;             ///< of the pixels valid in both
    std::vector<float> normal_errors_deg;           ///< likewise
};

/// Compares one frame of a run with the true one, of the same extent. `seen` is 1 where the surface had been seen often
/// enough for Pixels::kSeen; empty means everywhere. `truth_from_run` turns the run's normals into truth's world.
/// Throws Error when truth lacks a channel, or holds values that are not finite at a valid pixel.
FrameMeasurement measure_frame(uint32_t index, const ExrPlanes& truth, const ExrPlanes& run, const Image<uint8_t>& seen,
                               const glm::dmat3& truth_from_run);

}  // namespace patina::eval
