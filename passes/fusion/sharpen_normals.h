#pragma once

#include "engine/graph/frame_graph.h"
#include "passes/fusion/raycast.h"

namespace patina {

/// Normals of the cast model for shading: each is the mean over eight points about one and a half voxels away that lie
/// on one plane with its own. The gradient of the volume passes from one face to the other over about a voxel; beside
/// such an edge the normal is that of the face on whose plane most of the points around lie, also where the gradient
/// was not known. A flat face, on which three of eight points five voxels away lie with one normal, goes before all
/// others: towards its edges the gradient bends by angles that a curved face might have. Where the surface is rough, so
/// that fewer than four points agree, and not flat, the mean is over all that are within 60 degrees of the normal.
/// Returns `model` with its normals replaced; 0 where none is known. `focal_px` is that of its camera. Throws Error
/// when the images differ in extent.
RaycastImages add_sharpen_normals(graph::FrameGraph& frame, const RaycastImages& model, float focal_px, float voxel_m);

}  // namespace patina
