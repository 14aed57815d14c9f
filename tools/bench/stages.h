#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace patina::bench {

/// The stages of a frame, as in Tables 2 and 3 of the paper.
enum Stage : size_t { kGeometry, kObservation, kSegmentation, kSpecular, kAlbedo, kOther, kStages };

inline constexpr std::array<std::string_view, kStages> kStageNames = {
    "geometry", "observation", "segmentation", "specular materials", "albedo refinement", "other"};

/// The stage that a pass belongs to, or a fill, copy, upload or read-back on its behalf; kOther where no stage is
/// known.
Stage stage_of(std::string_view pass);

}  // namespace patina::bench
