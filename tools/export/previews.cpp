#include "tools/export/previews.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "engine/core/error.h"

namespace patina {
namespace {

const cv::Vec3b kInvalid(56, 56, 56);  ///< grey that neither a colour map nor a normal takes
const cv::Scalar kCaptionBackground(24, 24, 24);
const cv::Scalar kCaptionText(230, 230, 230);
constexpr int kCaptionHeight = 24;
constexpr int kGap = 4;

/// A picture as OpenCV holds it (8 bits, blue first), and what stands above it.
struct Panel {
    std::string caption;
    cv::Mat pixels;
};

/// 0..1 to 0..255; NaN becomes 0.
uchar to_byte(float value) {
    return value > 0 ? static_cast<uchar>(std::lround(std::min(value, 1.0f) * 255)) : uchar{0};
}

/// IEC 61966-2-1, 0..1 to 0..1; values beyond are left to to_byte().
float srgb_from_linear(float v) { return v <= 0.0031308f ? 12.92f * v : 1.055f * std::pow(v, 1 / 2.4f) - 0.055f; }

cv::Vec3b bgr(glm::vec3 rgb) { return {to_byte(rgb.b), to_byte(rgb.g), to_byte(rgb.r)}; }
cv::Vec3b color_pixel(glm::vec3 linear) {
    return bgr({srgb_from_linear(linear.r), srgb_from_linear(linear.g), srgb_from_linear(linear.b)});
}
cv::Vec3b color_pixel(sensor::SrgbPixel srgb) { return {srgb.b, srgb.g, srgb.r}; }
cv::Vec3b normal_pixel(glm::vec3 normal) { return bgr(normal * 0.5f + 0.5f); }

/// Turns every pixel into a colour, invalid ones into dark grey.
template <class Pixel, class ToColor>
cv::Mat draw(const Image<Pixel>& image, const Image<float>* valid, ToColor&& to_color) {
    const Extent2D extent = image.extent();
    cv::Mat drawn(static_cast<int>(extent.height), static_cast<int>(extent.width), CV_8UC3);
    auto* out = drawn.ptr<cv::Vec3b>();
    for (size_t i = 0; i < extent.area(); ++i) {
        const bool hit = !valid || valid->pixels()[i] > 0.5f;
        out[i] = hit ? cv::Vec3b(to_color(image.pixels()[i])) : kInvalid;
    }
    return drawn;
}

cv::Mat draw_input(const sensor::ColorImage& input) {
    return std::visit(
        [](const auto& image) { return draw(image, nullptr, [](const auto& pixel) { return color_pixel(pixel); }); },
        input);
}

/// The depths below which 1 % and 99 % of the valid pixels lie: single far pixels do not eat the colour range.
std::pair<float, float> depth_range(const FrameDump& model) {
    std::vector<float> depths;
    for (size_t i = 0; i < model.depth_m.pixels().size(); ++i) {
        const float depth = model.depth_m.pixels()[i];
        if (model.valid.pixels()[i] > 0.5f && std::isfinite(depth)) depths.push_back(depth);
    }
    if (depths.empty()) return {0.0f, 0.0f};
    std::ranges::sort(depths);
    return {depths[depths.size() / 100], depths[depths.size() - 1 - depths.size() / 100]};
}

Panel depth_panel(const FrameDump& model) {
    const auto [near_m, far_m] = depth_range(model);
    cv::Mat levels(1, 256, CV_8UC1), colors;
    for (int i = 0; i < 256; ++i) levels.at<uchar>(i) = static_cast<uchar>(i);
    cv::applyColorMap(levels, colors, cv::COLORMAP_TURBO);
    const float scale = far_m > near_m ? 1 / (far_m - near_m) : 0.0f;
    const auto to_color = [&, low = near_m](float depth) {
        return colors.at<cv::Vec3b>(to_byte((depth - low) * scale));
    };
    return {cv::format("depth %.2f m to %.2f m", static_cast<double>(near_m), static_cast<double>(far_m)),
            draw(model.depth_m, &model.valid, to_color)};
}

void check_extent(const char* what, Extent2D extent, Extent2D expected) {
    if (extent.area() == 0) throw Error("preview: the ", what, " picture is empty: ", extent);
    if (extent != expected) throw Error("preview: the ", what, " picture is ", extent, " but the colour is ", expected);
}

cv::Size panel_size(Extent2D extent, uint32_t largest_width) {
    const double scale = std::min(1.0, static_cast<double>(largest_width) / extent.width);
    const auto scaled = [scale](uint32_t length) { return std::max(1, static_cast<int>(std::lround(length * scale))); };
    return {scaled(extent.width), scaled(extent.height)};
}

cv::Mat scaled_to(const cv::Mat& pixels, cv::Size size) {
    if (pixels.size() == size) return pixels;
    cv::Mat scaled;
    cv::resize(pixels, scaled, size, 0, 0, pixels.cols > size.width ? cv::INTER_AREA : cv::INTER_LINEAR);
    return scaled;
}

/// As large as captions are, smaller where a narrow panel asks for it.
void write_caption(cv::Mat strip, const std::string& caption) {
    constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX, kMargin = 6;
    constexpr double kScale = 0.45;
    const int width = cv::getTextSize(caption, kFont, kScale, 1, nullptr).width;
    const double scale = kScale * std::min(1.0, static_cast<double>(strip.cols - 2 * kMargin) / std::max(1, width));
    if (scale <= 0) return;
    cv::putText(strip, caption, {kMargin, kCaptionHeight - 8}, kFont, scale, kCaptionText, 1, cv::LINE_AA);
}

cv::Mat side_by_side(const std::vector<Panel>& panels, cv::Size size) {
    const int count = static_cast<int>(panels.size());
    cv::Mat sheet(size.height + kCaptionHeight, count * size.width + (count - 1) * kGap, CV_8UC3, kCaptionBackground);
    for (int i = 0; i < count; ++i) {
        const Panel& panel = panels[static_cast<size_t>(i)];
        const int x = i * (size.width + kGap);
        write_caption(sheet(cv::Rect(x, 0, size.width, kCaptionHeight)), panel.caption);
        scaled_to(panel.pixels, size).copyTo(sheet(cv::Rect({x, kCaptionHeight}, size)));
    }
    return sheet;
}

}  // namespace

std::string preview_png(const sensor::ColorImage& input, const FrameDump& model, const PreviewOptions& options) {
    const Extent2D extent = model.rgb.extent();
    const Extent2D input_extent = std::visit([](const auto& image) { return image.extent(); }, input);
    check_extent("input", input_extent, input_extent);
    check_extent("reconstruction", extent, extent);
    check_extent("normal", model.normal.extent(), extent);
    check_extent("valid", model.valid.extent(), extent);

    const auto linear_pixel = [](glm::vec3 linear) { return color_pixel(linear); };
    std::vector<Panel> panels = {{options.title.empty() ? "input" : "input, " + options.title, draw_input(input)},
                                 {"reconstruction", draw(model.rgb, &model.valid, linear_pixel)},
                                 {"normals", draw(model.normal, &model.valid, normal_pixel)}};
    if (options.depth) {
        check_extent("depth", model.depth_m.extent(), extent);
        panels.push_back(depth_panel(model));
    }
    std::vector<uchar> png;
    cv::imencode(".png", side_by_side(panels, panel_size(extent, options.largest_panel_px)), png);
    return {png.begin(), png.end()};
}

}  // namespace patina
