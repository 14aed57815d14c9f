#pragma once

#include <string>

#include "scenes/description/scene.h"

namespace patina::scenes {

/// What a scene holds, and what a recording of so many frames of it has, for a person to read: lines of text as those
/// of format_report(). Nothing is rendered.
std::string format_scene_report(const SyntheticScene& scene, uint32_t frames);

}  // namespace patina::scenes
