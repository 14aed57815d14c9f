#pragma once

#include "scenes/render/render.h"

namespace patina::scenes {

/// Whether the light that comes straight from lamps is left to add_gather_light(), all lamps' alike: with area lights,
/// where any lamp has a size.
bool samples_direct_light(const SceneModel& scene, const RenderSettings& settings);

/// Adds to `images.radiance` what only random samples find, the mean of `settings.samples` for every pixel:
/// - light straight from lamps, if samples_direct_light(): drawn over the cone under which a lamp is seen;
/// - light that has been reflected up to `settings.bounces` times before: by paths along directions drawn from the
/// BRDF,
///   with one lamp asked at each vertex;
/// - the environment's light at every vertex: drawn by its radiance and by the BRDF, both weighted by the power
///   heuristic; what is in its way always darkens it, whatever `settings.shadows` says of lamps.
/// Lamps do not darken anything. Where no surface is seen but an environment, radiance becomes the environment's, a =
/// 0. The mean is exact in expectation, and depends on the seed, the frame index and the pixel alone; samples are added
/// in a fixed order. Does nothing where there is nothing to sample. Throws Error when there is, but no samples are
/// asked.
void add_gather_light(graph::FrameGraph& frame, const SceneModel& scene, const Intrinsics& camera,
                      const RigidTransform& world_from_camera, const RenderSettings& settings, uint32_t frame_index,
                      RenderedImages& images);

}  // namespace patina::scenes
