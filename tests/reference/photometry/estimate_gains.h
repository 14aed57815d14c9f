#pragma once

#include <array>

#include <glm/glm.hpp>

#include "patina/image.h"

namespace patina::reference {

/// One frame beside the model, as add_estimate_gains takes it.
struct ComparedColors {
    Image<glm::vec4> position_m, normal, model_color;  ///< of one extent
    Image<glm::vec4> color;                            ///< of that or a larger one
    glm::dvec3 camera_m{0};
};

struct ChannelGain {
    double gain = 1;
    size_t samples = 0;
};

/// The gains of red, green and blue by weighted quantiles and biweight means of the sorted log ratios themselves, where
/// the passes have a histogram. With fewer than `min_samples` a gain is `before`'s. Without leak.
std::array<ChannelGain, 3> estimate_gains(const ComparedColors& frame, glm::dvec3 before, double max_angle_degrees,
                                          size_t min_samples);

}  // namespace patina::reference
