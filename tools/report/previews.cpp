#include "tools/report/previews.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include "engine/core/error.h"
#include "export/page_picture.h"
#include "tools/report/drawing.h"

namespace patina {
namespace {

constexpr SrgbPixel kCaptionBackground(24, 24, 24);
const cv::Scalar kCaptionText(230, 230, 230);
constexpr uint32_t kCaptionHeight = 24;
constexpr uint32_t kGap = 4;
constexpr uint32_t kPairWidth = 960;
constexpr int kPairQuality = 85;

/// A drawing, and what stands above it.
struct Panel {
    std::string caption;
    Drawing drawing;
};

void add_segments_panel(const FrameDump& model, std::vector<Panel>& panels) {
    if (std::ranges::all_of(model.label.pixels(), [](float label) { return label == 0; })) return;
    const auto to_pixel = [](float label) { return label_pixel(static_cast<uint32_t>(label)); };
    panels.push_back({"segments", draw(model.label, &model.valid, to_pixel)});
}

Drawing draw_input(const ColorImage& input) {
    if (const auto* srgb = std::get_if<Drawing>(&input)) return *srgb;
    return draw(std::get<Image<glm::vec3>>(input), nullptr, color_pixel);
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
    const float scale = far_m > near_m ? 1 / (far_m - near_m) : 0.0f;
    const auto to_pixel = [&, low = near_m](float depth) { return map_pixel(ColorMap::kTurbo, (depth - low) * scale); };
    return {fmt::format("depth {:.2f} m to {:.2f} m", near_m, far_m), draw(model.depth_m, &model.valid, to_pixel)};
}

void check_extent(const char* what, Extent2D extent, Extent2D expected) {
    if (extent.area() == 0) throw Error("preview: the ", what, " picture is empty: ", extent);
    if (extent != expected) throw Error("preview: the ", what, " picture is ", extent, " but the colour is ", expected);
}

/// Above the panel at column `x`: as large as captions are, smaller where a narrow panel asks for it.
void write_caption(Drawing& sheet, uint32_t x, uint32_t panel_width, const std::string& caption) {
    constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX, kMargin = 6;
    constexpr double kScale = 0.45;
    cv::Mat strip(kCaptionHeight, static_cast<int>(panel_width), CV_8UC3, &sheet.at(x, 0),
                  sheet.extent().width * sizeof(SrgbPixel));
    const int width = cv::getTextSize(caption, kFont, kScale, 1, nullptr).width;
    const double scale = kScale * std::min(1.0, static_cast<double>(strip.cols - 2 * kMargin) / std::max(1, width));
    if (scale <= 0) return;
    cv::putText(strip, caption, {kMargin, kCaptionHeight - 8}, kFont, scale, kCaptionText, 1, cv::LINE_AA);
}

void paste(Drawing& sheet, const Drawing& drawing, uint32_t left, uint32_t top) {
    const uint32_t width = drawing.extent().width;
    for (uint32_t y = 0; y < drawing.extent().height; ++y) {
        std::copy_n(&drawing.at(0, y), width, &sheet.at(left, top + y));
    }
}

Drawing side_by_side(const std::vector<Panel>& panels, Extent2D panel) {
    const auto count = static_cast<uint32_t>(panels.size());
    Drawing sheet({count * panel.width + (count - 1) * kGap, panel.height + kCaptionHeight}, kCaptionBackground);
    for (uint32_t i = 0; i < count; ++i) {
        const uint32_t x = i * (panel.width + kGap);
        write_caption(sheet, x, panel.width, panels[i].caption);
        paste(sheet, scaled_to(panels[i].drawing, panel), x, kCaptionHeight);
    }
    return sheet;
}

void check_colors(const ColorImage& input, const FrameDump& model) {
    const Extent2D extent = model.rgb.extent();
    const Extent2D input_extent = std::visit([](const auto& image) { return image.extent(); }, input);
    check_extent("input", input_extent, input_extent);
    check_extent("reconstruction", extent, extent);
    check_extent("valid", model.valid.extent(), extent);
}

std::string jpeg_of(const Drawing& drawing) {
    const EncodedPicture picture = encoded_as_jpeg(drawing, kPairQuality);
    return {picture.bytes.begin(), picture.bytes.end()};
}

}  // namespace

PicturePair picture_pair(const ColorImage& input, const FrameDump& model, const std::string& caption) {
    check_colors(input, model);
    const Extent2D extent = fitted_extent(model.rgb.extent(), kPairWidth);
    const Drawing rendered = draw(model.shown_rgb(), &model.valid, color_pixel);
    return {caption, extent, jpeg_of(scaled_to(draw_input(input), extent)), jpeg_of(scaled_to(rendered, extent))};
}

std::string preview_png(const ColorImage& input, const FrameDump& model, const PreviewOptions& options) {
    check_colors(input, model);
    const Extent2D extent = model.rgb.extent();
    check_extent("normal", model.normal.extent(), extent);
    if (!model.kd.empty()) check_extent("albedo", model.kd.extent(), extent);
    if (!model.label.empty()) check_extent("label", model.label.extent(), extent);
    std::vector<Panel> panels = {
        {options.title.empty() ? "input" : "input, " + options.title, draw_input(input)},
        {model.kd.empty() ? "reconstruction" : "re-rendering", draw(model.shown_rgb(), &model.valid, color_pixel)}};
    if (!model.kd.empty()) panels.push_back({"diffuse albedo", draw(model.shown_kd(), &model.valid, color_pixel)});
    add_segments_panel(model, panels);
    panels.push_back({"normals", draw(model.normal, &model.valid, normal_pixel)});
    if (options.depth) {
        check_extent("depth", model.depth_m.extent(), extent);
        panels.push_back(depth_panel(model));
    }
    return png_of(side_by_side(panels, fitted_extent(extent, options.largest_panel_px)));
}

}  // namespace patina
