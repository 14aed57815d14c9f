#include "scenes/description/noise.h"

#include <map>
#include <string>
#include <vector>

#include "engine/core/did_you_mean.h"
#include "engine/core/error.h"

namespace patina::scenes {
namespace {

const std::map<std::string_view, SensorNoise>& presets() {
    // Nguyen, Izadi, Lovell 2012 measured axial noise of the first Kinect; a time-of-flight sensor's grows far slower.
    // A pixel at an edge gathers light of both sides: time of flight averages them nearly everywhere, while structured
    // light's window mostly sides with one. Small webcam pixels hold some thousand electrons.
    static const std::map<std::string_view, SensorNoise> kPresets = {
        {"none", {}},
        {"kinect1",
         {.depth_constant_m = 0.0012,
          .depth_quadratic_per_m = 0.0019,
          .depth_offset_m = 0.4,
          .flying_pixels = 0.2,
          .color_read = 0.003,
          .color_shot = 1.0 / 4000}},
        {"kinect2",
         {.depth_constant_m = 0.001,
          .depth_quadratic_per_m = 0.00025,
          .depth_offset_m = 0,
          .flying_pixels = 0.5,
          .color_read = 0.002,
          .color_shot = 1.0 / 8000}},
    };
    return kPresets;
}

}  // namespace

SensorNoise noise_preset(std::string_view name) {
    const auto preset = presets().find(name);
    if (preset == presets().end()) {
        std::vector<std::string> names;
        for (const auto& [known, noise] : presets()) names.emplace_back(known);
        throw Error("there is no noise preset '", name, "'; there is: ", noise_preset_names(),
                    did_you_mean(name, names));
    }
    return preset->second;
}

std::string noise_preset_names() {
    std::string names;
    for (const auto& [name, noise] : presets()) names.append(names.empty() ? "" : ", ").append(name);
    return names;
}

}  // namespace patina::scenes
