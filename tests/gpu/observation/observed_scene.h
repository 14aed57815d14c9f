#pragma once

#include "tests/gpu/observation/observation_rig.h"
#include "tests/reference/observation/collect_observations.h"

// Frames of analytic scenes, and what the observations make of them, for tests.

namespace patina::observed_scene {

inline const Intrinsics kCamera{{160, 120}, 150, 150, 79.5, 59.5, {}};

/// Fields of a record as the reference takes them.
reference::ObservedVoxel unpack(const RecordContent& content);

double degrees_between(glm::dvec3 a, glm::dvec3 b);

/// A linear colour that changes linearly over the image.
inline glm::vec4 ramp(double x, double y) { return {0.1 + 0.004 * x, 0.2 + 0.003 * y, 0.6 - 0.002 * x, 1}; }

/// The scene as kCamera sees it from a pose, in the colours of ramp().
RigFrame frame_of(const reference::DistanceField& field, const RigidTransform& pose);

}  // namespace patina::observed_scene
