#pragma once

#include <cstdint>
#include <string>

#include "patina/frame.h"
#include "sensor/recording/recorded_frame.h"

namespace patina::sensor {

/// How much of the colour pictures of a sequence is as bright as it may be, or brighter.
struct ExposureShares {
    double clipped = 0;  ///< of the pixels, those with a channel at 255, or linear 1
    double bright = 0;   ///< those of kLampThreshold and more: lamps, where the exposure is low
};

/// The luminance from which a pixel belongs to a lamp, by default (FindLightsSettings::threshold).
inline constexpr float kLampThreshold = 0.1f;

ExposureShares exposure_shares(const ColorImage& color);

/// Judges a sequence's exposure while it is recorded.
class ExposureCheck {
  public:
    explicit ExposureCheck(SequenceRole role) : role_(role) {}

    void add(const ColorImage& color);
    const ExposureShares& last() const { return last_; }

    /// One sentence on what to change, of all frames so far; empty where all is well.
    std::string advice() const;

  private:
    SequenceRole role_;
    ExposureShares last_;
    uint32_t frames_ = 0;
    uint32_t frames_clipped_ = 0;  ///< in which more is clipped than the role allows
    uint32_t frames_bright_ = 0;   ///< in which more is bright than lamps are
    uint32_t frames_lit_ = 0;      ///< in which anything is bright
};

/// What a person is to do in a sequence's recording.
const char* instruction(SequenceRole role);

}  // namespace patina::sensor
