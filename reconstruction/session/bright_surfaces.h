#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <variant>
#include <vector>

#include <glm/glm.hpp>

#include "engine/core/srgb.h"
#include "patina/frame.h"
#include "patina/image.h"

namespace patina {

/// How bright a recording's bright surfaces are, without a lamp to tell more of them. A clipped pixel shows a lamp, the
/// sky or a patch of sun as likely as a surface in the room's usual light, and does not count. Takes half a megabyte,
/// however many pixels it has seen.
class BrightSurfaces {
  public:
    static constexpr float kClipped = 0.98f;  ///< 253 of 255: a compressed picture's 255

    /// Takes some of the pixels, linear.
    void add(const ColorImage& color) {
        if (const auto* linear = std::get_if<Image<glm::vec3>>(&color))
            add(
                *linear, [](glm::vec3 pixel) { return pixel; }, std::numeric_limits<float>::infinity());
        if (const auto* encoded = std::get_if<Image<SrgbPixel>>(&color)) add(*encoded, linear_color, kClipped);
    }

    /// The irradiance over pi under which bright surfaces have this albedo; 0 without any pixel. White: what colour the
    /// light has cannot be told from that of the surfaces. Off by 1/128 at most.
    glm::vec3 ambient(float bright_albedo) const {
        if (count_ == 0 && clipped_) return glm::vec3(1 / bright_albedo);
        const auto at = static_cast<uint64_t>(kBrightQuantile * static_cast<double>(std::max(count_, uint64_t{1}) - 1));
        uint64_t below = 0;
        for (const Bin& bin : bins_) {
            below += bin.count;
            if (below > at)
                return glm::vec3(static_cast<float>(bin.sum / static_cast<double>(bin.count)) / bright_albedo);
        }
        return glm::vec3(0);
    }

  private:
    static constexpr double kBrightQuantile = 0.9;
    static constexpr size_t kStride = 61;  // pixels; shares no factor with widths
    /// A bin holds the values whose exponent and first 7 binary places are the same.
    static constexpr int kDroppedBits = 16;
    static constexpr size_t kBins = size_t{0x7f800000u >> kDroppedBits};  // up to infinity

    struct Bin {
        uint64_t count = 0;
        double sum = 0;  ///< so that a single value comes out as it is
    };

    template <class Pixel, class ToLinear>
    void add(const Image<Pixel>& image, ToLinear&& to_linear, float clipped) {
        for (size_t i = 0; i < image.pixels().size(); i += kStride) {
            const glm::vec3 pixel = to_linear(image.pixels()[i]);
            const float most = std::max({pixel.r, pixel.g, pixel.b, 0.0f});
            if (!std::isfinite(most)) continue;
            if (most >= clipped) {
                clipped_ = true;
                continue;
            }
            Bin& bin = bins_[std::bit_cast<uint32_t>(std::abs(most)) >> kDroppedBits];
            ++bin.count;
            bin.sum += double{most};
            ++count_;
        }
    }

    std::vector<Bin> bins_ = std::vector<Bin>(kBins);  ///< of the pixels' brightest channels
    uint64_t count_ = 0;
    bool clipped_ = false;  ///< a pixel was
};

}  // namespace patina
