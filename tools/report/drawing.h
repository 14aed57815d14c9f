#pragma once

#include <cstdint>
#include <string>

#include <glm/glm.hpp>

#include "patina/frame.h"
#include "patina/image.h"

namespace patina {

/// A picture to look at.
using Drawing = Image<SrgbPixel>;

/// Grey that neither a colour map nor a normal takes, for pixels without a value.
inline constexpr SrgbPixel kNoValue{56, 56, 56};

/// Linear radiance or albedo, encoded for sRGB (IEC 61966-2-1); what lies outside 0..1 is clipped, NaN is black.
SrgbPixel color_pixel(glm::vec3 linear);

/// A unit normal as n / 2 + 1/2.
SrgbPixel normal_pixel(glm::vec3 normal);

/// Colour maps for 0..1; what lies outside is clipped, NaN is 0.
enum class ColorMap {
    kTurbo,    ///< from blue to red: many steps can be told apart
    kViridis,  ///< from dark blue to yellow; even to the eye, in grey print too
    kInferno,  ///< from black to pale yellow; even to the eye, in grey print too
};
SrgbPixel map_pixel(ColorMap map, float value);

/// A colour for a label, the same in every picture; neighbouring labels differ clearly. Label 0 is kNoValue.
SrgbPixel label_pixel(uint32_t label);

/// Turns every pixel into a colour with `to_pixel`; where `valid`, if given, is at most 1/2, into kNoValue.
template <class Pixel, class ToPixel>
Drawing draw(const Image<Pixel>& image, const Image<float>* valid, ToPixel&& to_pixel) {
    Drawing drawing(image.extent(), kNoValue);
    for (size_t i = 0; i < image.pixels().size(); ++i) {
        if (!valid || valid->pixels()[i] > 0.5f) drawing.pixels()[i] = to_pixel(image.pixels()[i]);
    }
    return drawing;
}

/// As large as `extent`, averaged where it shrinks.
Drawing scaled_to(const Drawing& drawing, Extent2D extent);

/// The extent in the same proportions, but no wider than this; at least 1 x 1.
Extent2D fitted_extent(Extent2D extent, uint32_t largest_width);

/// The bytes of a PNG file.
std::string png_of(const Drawing& drawing);

}  // namespace patina
