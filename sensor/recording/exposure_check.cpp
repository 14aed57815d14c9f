#include "sensor/recording/exposure_check.h"

#include <algorithm>
#include <cmath>

#include "engine/core/error.h"
#include "engine/core/srgb.h"

namespace patina::sensor {

namespace {

/// A lamp or a highlight is clipped in the reflectance sequence, and may be; a wall may not.
constexpr double kMostClipped = 0.05;
/// A single clipped pixel hides how bright a lamp is. One of a million may be the sensor's own.
constexpr double kMostClippedOfLamps = 1e-6;
/// Lamps in sight are small; more than this share is the room, which the search would take for lamps.
constexpr double kMostBrightOfLamps = 0.2;
/// A few frames of a sweep may be as they are.
constexpr double kToleratedFrames = 0.1;

template <class Pixel, class IsClipped, class IsBright>
ExposureShares shares(const Image<Pixel>& image, IsClipped is_clipped, IsBright is_bright) {
    size_t clipped = 0, bright = 0;
    for (const Pixel& pixel : image.pixels()) {
        const auto largest = std::max({pixel.r, pixel.g, pixel.b});
        clipped += is_clipped(largest);
        bright += is_bright(largest);
    }
    const auto of = static_cast<double>(std::max<size_t>(image.pixels().size(), 1));
    return {static_cast<double>(clipped) / of, static_cast<double>(bright) / of};
}

std::string percent(double share) { return text(std::round(1000 * share) / 10, " %"); }

}  // namespace

ExposureShares exposure_shares(const ColorImage& color) {
    if (const auto* codes = std::get_if<Image<SrgbPixel>>(&color)) {
        const auto threshold = static_cast<int>(std::lround(255 * srgb_encoded(kLampThreshold)));
        return shares(
            *codes, [](uint8_t v) { return v == 255; }, [threshold](uint8_t v) { return v > threshold; });
    }
    return shares(
        std::get<Image<glm::vec3>>(color), [](float v) { return v >= 1; }, [](float v) { return v > kLampThreshold; });
}

void ExposureCheck::add(const ColorImage& color) {
    last_ = exposure_shares(color);
    ++frames_;
    frames_clipped_ += last_.clipped > (role_ == SequenceRole::kMain ? kMostClipped : kMostClippedOfLamps);
    frames_bright_ += last_.bright > kMostBrightOfLamps;
    frames_lit_ += last_.bright > 0;
}

std::string ExposureCheck::advice() const {
    const auto many = [this](uint32_t count) { return count > kToleratedFrames * frames_; };
    if (frames_ == 0) return "";
    if (role_ == SequenceRole::kMain) {
        if (!many(frames_clipped_)) return "";
        return text("in ", frames_clipped_, " of ", frames_, " frames more than ", percent(kMostClipped),
                    " of the pixels are clipped: shorten the exposure, or the albedo there stays unknown");
    }
    if (many(frames_bright_))
        return text("in ", frames_bright_, " of ", frames_, " frames more than ", percent(kMostBrightOfLamps),
                    " of the pixels are bright: shorten the exposure until lamps alone are visible");
    if (frames_clipped_ > 0)
        return text("in ", frames_clipped_, " of ", frames_,
                    " frames a lamp is clipped: shorten the exposure, or its intensity is known from below only");
    if (frames_lit_ == 0) return "no frame shows a lamp: look at each lamp, or lengthen the exposure";
    return "";
}

const char* instruction(SequenceRole role) {
    return role == SequenceRole::kMain
               ? "reflectance: move slowly, and see each surface from many directions"
               : "low exposure: shorten the exposure until lamps alone are visible and none is clipped, start near a "
                 "place that you have recorded, and look at each lamp for several frames from several places";
}

}  // namespace patina::sensor
