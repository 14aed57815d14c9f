#include "tools/report/drawing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace patina {
namespace {

/// 0..1 to 0..255; NaN becomes 0.
uint8_t to_byte(float value) {
    return value > 0 ? static_cast<uint8_t>(std::lround(std::min(value, 1.0f) * 255)) : uint8_t{0};
}

SrgbPixel to_pixel(glm::vec3 v) { return {to_byte(v.r), to_byte(v.g), to_byte(v.b)}; }

/// IEC 61966-2-1, 0..1 to 0..1; values beyond are left to to_byte().
float srgb_from_linear(float v) { return v <= 0.0031308f ? 12.92f * v : 1.055f * std::pow(v, 1 / 2.4f) - 0.055f; }

using Levels = std::array<SrgbPixel, 256>;

Levels levels_of(cv::ColormapTypes map) {
    cv::Mat indices(1, 256, CV_8UC1), colors;
    for (int i = 0; i < 256; ++i) indices.at<uint8_t>(i) = static_cast<uint8_t>(i);
    cv::applyColorMap(indices, colors, map);
    Levels levels;
    for (int i = 0; i < 256; ++i) {
        const auto& bgr = colors.at<cv::Vec3b>(i);
        levels[static_cast<size_t>(i)] = {bgr[2], bgr[1], bgr[0]};
    }
    return levels;
}

/// A view of the drawing's pixels, red first.
cv::Mat mat_of(const Drawing& drawing) {
    static_assert(sizeof(SrgbPixel) == 3);
    return {static_cast<int>(drawing.extent().height), static_cast<int>(drawing.extent().width), CV_8UC3,
            const_cast<SrgbPixel*>(drawing.pixels().data())};
}

}  // namespace

SrgbPixel color_pixel(glm::vec3 linear) {
    return to_pixel({srgb_from_linear(linear.r), srgb_from_linear(linear.g), srgb_from_linear(linear.b)});
}

SrgbPixel normal_pixel(glm::vec3 normal) { return to_pixel(normal * 0.5f + 0.5f); }

SrgbPixel map_pixel(ColorMap map, float value) {
    static const std::array<Levels, 3> kLevels{levels_of(cv::COLORMAP_TURBO), levels_of(cv::COLORMAP_VIRIDIS),
                                               levels_of(cv::COLORMAP_INFERNO)};
    return kLevels[static_cast<size_t>(map)][to_byte(value)];
}

SrgbPixel label_pixel(uint32_t label) {
    if (label == 0) return kNoValue;
    // Steps of the golden ratio spread any number of hues evenly; three lightnesses tell neighbouring hues apart.
    const double turn = std::fmod(label * 0.61803398875, 1.0);
    const double lightness = 0.55 + 0.15 * (label % 3);
    const auto channel = [&](double phase) {
        const double wave = 0.5 + 0.5 * std::cos(2 * std::numbers::pi * (turn - phase));
        return static_cast<float>(lightness * (0.25 + 0.75 * wave));
    };
    return to_pixel({channel(0), channel(1.0 / 3), channel(2.0 / 3)});
}

Drawing scaled_to(const Drawing& drawing, Extent2D extent) {
    if (drawing.extent() == extent) return drawing;
    Drawing scaled(extent);
    cv::Mat target = mat_of(scaled);
    const int method = extent.width < drawing.extent().width ? cv::INTER_AREA : cv::INTER_LINEAR;
    cv::resize(mat_of(drawing), target, target.size(), 0, 0, method);
    return scaled;
}

Extent2D fitted_extent(Extent2D extent, uint32_t largest_width) {
    const double scale = std::min(1.0, static_cast<double>(largest_width) / extent.width);
    const auto fitted = [scale](uint32_t length) {
        return static_cast<uint32_t>(std::max(1l, std::lround(length * scale)));
    };
    return {fitted(extent.width), fitted(extent.height)};
}

std::string png_of(const Drawing& drawing) {
    cv::Mat bgr;
    cv::cvtColor(mat_of(drawing), bgr, cv::COLOR_RGB2BGR);
    std::vector<uint8_t> png;
    cv::imencode(".png", bgr, png);
    return {png.begin(), png.end()};
}

}  // namespace patina
