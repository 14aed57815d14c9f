#pragma once

#include <cstdint>

#include "scenes/description/scene.h"

namespace patina::scenes {

/// Fewest views of with_novel_views().
inline constexpr uint32_t kFewestNovelViews = 2;

/// The scene seen from where its path never comes: frame i of `count` is half a metre to the side of a place of the
/// path, left and right in turns, up to 0.4 m higher or lower, and looks at what the path's camera has 2 m in front of
/// it. Views are spread over the first `duration_s` of the path. They keep 0.2 m away from everything and pass through
/// nothing on their way there, so that some are nearer. Poses, depth and colours have no noise. At least
/// kFewestNovelViews.
SyntheticScene with_novel_views(SyntheticScene scene, uint32_t count, double duration_s);

/// The scene under lamps that its recording never has: each moves by up to 60 % of its distance to the middle of the
/// objects, and has another colour and share of the same total light. An environment is turned.
SyntheticScene with_other_light(SyntheticScene scene);

}  // namespace patina::scenes
