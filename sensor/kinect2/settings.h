#pragma once

#include <optional>
#include <variant>

#include "sensor/kinect2/commands.h"

namespace patina::sensor::kinect2 {

/// The camera chooses exposure time and gain.
struct AutomaticExposure {
    float compensation = 0;  ///< -2 to 2
};

/// The camera chooses the gain alone.
struct SemiAutomaticExposure {
    float exposure_ms = 16;  ///< 0 to 640
};

/// Nothing changes by itself, as a low-exposure pass needs it.
struct ManualExposure {
    float integration_ms = 16;  ///< 0 to 66; above 33 the colour stream has 15 frames a second
    float analog_gain = 1;      ///< 1 to 4
};

using ExposureControl = std::variant<AutomaticExposure, SemiAutomaticExposure, ManualExposure>;

/// Fixed gains of the colour channels.
struct WhiteBalanceGains {
    float red = 1, green = 1, blue = 1;
};

/// Throws Error when a value is outside its range.
void check(const ExposureControl& exposure);
void check(const std::optional<WhiteBalanceGains>& gains);

/// Sets the colour camera's exposure while the device runs. Throws as check() and
/// Commands::execute().
void set_exposure(Commands& commands, const ExposureControl& exposure);

/// Fixes the white balance; empty: the camera chooses it. Throws as set_exposure().
void set_white_balance(Commands& commands, const std::optional<WhiteBalanceGains>& gains);

/// The gains that are in force, for example to fix what the camera chose.
WhiteBalanceGains white_balance(Commands& commands);

}  // namespace patina::sensor::kinect2
