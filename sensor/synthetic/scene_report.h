#pragma once

#include <string>

#include "sensor/synthetic/scene.h"

namespace patina::sensor {

/// What a scene holds, and what a recording of so many frames of it has, for a person to read: lines of text as those
/// of format_report(). Nothing is rendered.
std::string format_scene_report(const Scene& scene, uint32_t frames);

}  // namespace patina::sensor
