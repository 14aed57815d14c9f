#pragma once

#include <string_view>

namespace patina::viewer {

// The files of this folder, as the build finds them.
extern const std::string_view kPage, kStyle, kScript;
extern const std::string_view kSurfaceVertex, kSurfaceFragment, kLampVertex, kLampFragment;
/// shaders/lib/brdf/ward.glsl with what it includes.
extern const std::string_view kWard;

}  // namespace patina::viewer
