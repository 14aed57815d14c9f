#pragma once

#include "passes/reflectance/find_due_records.h"

namespace patina {

/// Gathers the light that reaches the records of `march` from what is around them: reflectance.gathered_rays rays of
/// each, in cosine-weighted directions that change from update to update, are marched through the TSDF from above the
/// record's surface. Where a ray meets a surface, that surface's fused colour arrives, which is linear radiance with
/// all its own light, bounces included. Where that is a lamp, nothing does: refinement adds lamps by their intensities.
/// The record's mean, ReflectanceStateIds::gathered, takes the rays in (lib/records/gathered_light.glsl). After some
/// 200 rays it is a sliding mean, which follows changes of the map. Along rays that leave params.ball_m or meet nothing
/// the far field arrives (collect_far_field.h); where it is not known either, they are counted apart. `forgets`: what
/// was gathered before counts no longer, as under other lights.
void add_gather_irradiance(graph::FrameGraph& frame, ReflectanceFrame& reflectance, const RecordList& march,
                           bool forgets = false);

}  // namespace patina
