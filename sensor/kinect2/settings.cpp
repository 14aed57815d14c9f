#include "sensor/kinect2/settings.h"

#include <bit>
#include <cmath>

namespace patina::sensor::kinect2 {
namespace {

enum Setting : uint32_t {
    kExposureMode = 0,
    kIntegrationTime = 1,
    kWhiteBalanceMode = 10,
    kSetRedGain = 11,
    kSetGreenGain = 12,
    kSetBlueGain = 13,
    kGetRedGain = 14,
    kGetGreenGain = 15,
    kGetBlueGain = 16,
    kExposureTime = 17,
    kAnalogGain = 21,
    kCompensation = 23,
    kAntiFlicker = 25,
};

enum ExposureMode : uint32_t { kAutomatic = 0, kSemiAutomatic = 3, kManual = 4 };

// What ofxKinectV2 sends; libfreenect2 names the setting and no values.
enum WhiteBalanceMode : uint32_t { kAutomaticBalance = 1, kManualBalance = 3 };

void set(Commands& commands, Setting setting, uint32_t value) { commands.color_setting(setting, value); }
void set(Commands& commands, Setting setting, float value) { set(commands, setting, std::bit_cast<uint32_t>(value)); }

void expect_within(const char* what, float value, float low, float high) {
    if (!(value >= low && value <= high)) {
        throw Error("the Kinect's ", what, " is ", value, ", must be within ", low, " and ", high);
    }
}

void begin(Commands& commands, ExposureMode mode) {
    set(commands, kAntiFlicker, uint32_t{0});
    set(commands, kExposureMode, uint32_t{mode});
}

void check(const AutomaticExposure& exposure) { expect_within("exposure compensation", exposure.compensation, -2, 2); }

void check(const SemiAutomaticExposure& exposure) {
    expect_within("exposure time in ms", exposure.exposure_ms, 0, 640);
}

void check(const ManualExposure& exposure) {
    expect_within("integration time in ms", exposure.integration_ms, 0, 66);
    expect_within("analog gain", exposure.analog_gain, 1, 4);
}

void apply(Commands& commands, const AutomaticExposure& exposure) {
    begin(commands, kAutomatic);
    set(commands, kCompensation, exposure.compensation);
}

void apply(Commands& commands, const SemiAutomaticExposure& exposure) {
    begin(commands, kSemiAutomatic);
    set(commands, kExposureTime, exposure.exposure_ms);
}

void apply(Commands& commands, const ManualExposure& exposure) {
    begin(commands, kManual);
    set(commands, kIntegrationTime, exposure.integration_ms);
    set(commands, kAnalogGain, exposure.analog_gain);
}

}  // namespace

void check(const ExposureControl& exposure) {
    std::visit([](const auto& kind) { check(kind); }, exposure);
}

void check(const std::optional<WhiteBalanceGains>& gains) {
    if (!gains) return;
    for (const float gain : {gains->red, gains->green, gains->blue}) {
        if (!(gain > 0) || !std::isfinite(gain)) {
            throw Error("the Kinect's white balance gain is ", gain, ", must be positive");
        }
    }
}

void set_exposure(Commands& commands, const ExposureControl& exposure) {
    check(exposure);
    std::visit([&](const auto& kind) { apply(commands, kind); }, exposure);
}

void set_white_balance(Commands& commands, const std::optional<WhiteBalanceGains>& gains) {
    check(gains);
    if (!gains) return set(commands, kWhiteBalanceMode, uint32_t{kAutomaticBalance});
    set(commands, kWhiteBalanceMode, uint32_t{kManualBalance});
    set(commands, kSetRedGain, gains->red);
    set(commands, kSetGreenGain, gains->green);
    set(commands, kSetBlueGain, gains->blue);
}

WhiteBalanceGains white_balance(Commands& commands) {
    const auto gain = [&](Setting setting) { return std::bit_cast<float>(commands.color_setting(setting, 0)); };
    const float red = gain(kGetRedGain), green = gain(kGetGreenGain), blue = gain(kGetBlueGain);
    return {red, green, blue};
}

}  // namespace patina::sensor::kinect2
