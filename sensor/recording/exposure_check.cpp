#include "sensor/recording/exposure_check.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/core/error.h"
#include "engine/core/luminance.h"
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

/// The luminance of sRGB codes by table: pictures are judged as they come.
class CodeLuminance {
  public:
    CodeLuminance() {
        for (size_t code = 0; code < kCodes; ++code) {
            const glm::vec3 linear = linear_color(SrgbPixel(static_cast<uint8_t>(code)));
            red_[code] = luminance(glm::vec3(linear.r, 0, 0));
            green_[code] = luminance(glm::vec3(0, linear.g, 0));
            blue_[code] = luminance(glm::vec3(0, 0, linear.b));
        }
    }
    float operator()(SrgbPixel pixel) const { return red_[pixel.r] + green_[pixel.g] + blue_[pixel.b]; }

  private:
    static constexpr size_t kCodes = 256;
    std::array<float, kCodes> red_{}, green_{}, blue_{};
};

template <class Pixel, class LuminanceOf>
ExposureShares shares(const Image<Pixel>& image, const Pixel& full, LuminanceOf luminance_of) {
    size_t clipped = 0, bright = 0;
    for (const Pixel& pixel : image.pixels()) {
        clipped += pixel.r >= full.r || pixel.g >= full.g || pixel.b >= full.b;
        bright += luminance_of(pixel) >= kLampThreshold;
    }
    const auto of = static_cast<double>(std::max<size_t>(image.pixels().size(), 1));
    return {static_cast<double>(clipped) / of, static_cast<double>(bright) / of};
}

std::string percent(double share) { return text(std::round(1000 * share) / 10, " %"); }

}  // namespace

ExposureShares exposure_shares(const ColorImage& color) {
    static const CodeLuminance kLuminance;
    if (const auto* codes = std::get_if<Image<SrgbPixel>>(&color)) return shares(*codes, SrgbPixel(255), kLuminance);
    return shares(std::get<Image<glm::vec3>>(color), glm::vec3(1), [](glm::vec3 linear) { return luminance(linear); });
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
