#include "tools/report/plan.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "export/html.h"
#include "tools/report/drawing.h"

namespace patina {

namespace {

constexpr double kWidth_px = 640, kMost_px = 640;
constexpr double kMargin_m = 0.1;

constexpr std::string_view kPlanStyle = R"css(
svg.plan { display: block; width: 100%; max-width: 40rem; height: auto; }
.plan .path { fill: none; stroke: #d81b60; stroke-width: 2; stroke-linejoin: round; }
.plan .start { fill: #d81b60; }
.plan .lamp { fill: #ffd54a; stroke: #333333; stroke-width: 1.5; }
.plan .bar { stroke: var(--text); stroke-width: 2; }
.plan text { fill: var(--text); font: 13px system-ui, sans-serif; }
)css";

/// From metres, x to the right and z down, to pixels.
struct Scale {
    glm::dvec2 low_m{0};
    double px_per_m = 1;

    glm::dvec2 px(glm::dvec3 point_m) const { return (glm::dvec2(point_m.x, point_m.z) - low_m) * px_per_m; }
};

/// Pictures of the highest surface that faces up.
class TopView {
  public:
    TopView(Extent2D extent, const Scale& scale)
        : colors_(extent, kNoValue), height_m_(extent, -1e30f), scale_(scale) {}

    /// `page`: that the part lies in; null: vertices have colours.
    void add(const ScenePart& part, const Image<glm::vec3>* page) {
        for (const auto& triangle : part.triangles) {
            const uint32_t a = triangle[0], b = triangle[1], c = triangle[2];
            const std::array<glm::vec3, 3> corners{part.positions_m[a], part.positions_m[b], part.positions_m[c]};
            if (glm::cross(corners[1] - corners[0], corners[2] - corners[0]).y <= 0) continue;
            const auto color_at = [&](float u, float v, float w) {
                if (page) return texel_at(*page, u * part.places[a] + v * part.places[b] + w * part.places[c]);
                return u * part.base[a] + v * part.base[b] + w * part.base[c];
            };
            add(corners, color_at);
        }
    }

    const Drawing& colors() const { return colors_; }

  private:
    template <class ColorAt>
    void add(const std::array<glm::vec3, 3>& corners, const ColorAt& color_at) {
        std::array<glm::dvec2, 3> at;
        glm::dvec2 low(1e30), high(-1e30);
        for (size_t i = 0; i < 3; ++i) {
            at[i] = scale_.px(glm::dvec3(corners[i]));
            low = glm::min(low, at[i]);
            high = glm::max(high, at[i]);
        }
        const auto cross = [](glm::dvec2 a, glm::dvec2 b) { return a.x * b.y - a.y * b.x; };
        const double area = cross(at[1] - at[0], at[2] - at[0]);
        if (area == 0) return;
        const auto last = [](double edge, uint32_t size) { return std::min(edge, static_cast<double>(size) - 1); };
        for (auto y = static_cast<uint32_t>(std::max(low.y, 0.0)); y <= last(high.y, colors_.extent().height); ++y) {
            for (auto x = static_cast<uint32_t>(std::max(low.x, 0.0)); x <= last(high.x, colors_.extent().width); ++x) {
                const glm::dvec2 pixel = glm::dvec2(x, y) + 0.5 - at[0];
                const auto v = static_cast<float>(cross(pixel, at[2] - at[0]) / area);
                const auto w = static_cast<float>(cross(at[1] - at[0], pixel) / area);
                if (v < -0.02f || w < -0.02f || v + w > 1.02f) continue;
                const float height_m = (1 - v - w) * corners[0].y + v * corners[1].y + w * corners[2].y;
                if (height_m <= height_m_.at(x, y)) continue;
                height_m_.at(x, y) = height_m;
                colors_.at(x, y) = color_pixel(color_at(1 - v - w, v, w));
            }
        }
    }

    Drawing colors_;
    Image<float> height_m_;
    const Scale& scale_;
};

std::string path_svg(std::span<const glm::dvec3> path_m, const Scale& scale) {
    if (path_m.empty()) return {};
    std::string points;
    for (const glm::dvec3 point_m : path_m)
        points += fmt::format("{:.1f},{:.1f} ", scale.px(point_m).x, scale.px(point_m).y);
    const glm::dvec2 start = scale.px(path_m.front());
    return fmt::format(
        "<polyline class='path' points='{}'/>\n<circle class='start' cx='{:.1f}' cy='{:.1f}' r='5'>"
        "<title>where the recording begins</title></circle>\n",
        points, start.x, start.y);
}

std::string lamps_svg(const std::vector<Light>& lights, const Scale& scale) {
    std::string svg;
    for (size_t i = 0; i < lights.size(); ++i) {
        const glm::dvec2 at = scale.px(lights[i].position_m);
        svg += fmt::format(
            "<circle class='lamp' cx='{:.1f}' cy='{:.1f}' r='7'><title>lamp {}, {:.2f} m above the "
            "floor</title></circle>\n",
            at.x, at.y, i + 1, lights[i].position_m.y);
    }
    return svg;
}

std::string bar_svg(const Scale& scale, double width_px, double top_px) {
    const double length_m = width_px / scale.px_per_m > 30 ? 10 : width_px / scale.px_per_m > 3 ? 1 : 0.1;
    const double length_px = length_m * scale.px_per_m;
    return fmt::format("<path class='bar' d='M0 {0:.1f}H{1:.1f}'/><text x='{2:.1f}' y='{3:.1f}'>{4} m</text>\n",
                       top_px + 8, length_px, length_px + 8, top_px + 13, length_m);
}

}  // namespace

std::string plan_svg(const SceneParts& scene, std::span<const glm::dvec3> path_m) {
    if (scene.triangles() == 0) return {};
    const auto [surface_low, surface_high] = bounds_of(scene);
    glm::dvec3 low(surface_low), high(surface_high);
    const auto widen = [&](glm::dvec3 point_m) { low = glm::min(low, point_m), high = glm::max(high, point_m); };
    for (const glm::dvec3 point_m : path_m) widen(point_m);
    for (const Light& light : scene.lights) widen(light.position_m);
    const glm::dvec3 size_m = high - low + 2 * kMargin_m;
    const Scale scale{glm::dvec2(low.x, low.z) - kMargin_m, std::min(kWidth_px / size_m.x, kMost_px / size_m.z)};
    const Extent2D extent{static_cast<uint32_t>(std::ceil(size_m.x * scale.px_per_m)),
                          static_cast<uint32_t>(std::ceil(size_m.z * scale.px_per_m))};
    TopView view(extent, scale);
    for (const ScenePart& part : scene.parts)
        if (part.page == ScenePart::kNoPage) view.add(part, nullptr);
    for (uint32_t number = 0; number < scene.pages.size(); ++number) {
        const Image<glm::vec3> page = linear_page(scene.pages[number]);
        for (const ScenePart& part : scene.parts)
            if (part.page == number) view.add(part, &page);
    }
    return fmt::format(
               "<svg class='plan' viewBox='0 0 {0} {1}' role='img'>\n<title>Plan of the scene, {2:.1f} by {3:.1f} m, "
               "with {4} "
               "lamps and the camera's way</title>\n<image width='{0}' height='{5}' "
               "href='data:image/png;base64,{6}'/>\n",
               extent.width, extent.height + 20, size_m.x, size_m.z, scene.lights.size(), extent.height,
               base64(png_of(view.colors()))) +
           path_svg(path_m, scale) + lamps_svg(scene.lights, scale) + bar_svg(scale, extent.width, extent.height) +
           "</svg>\n";
}

std::string_view plan_style() { return kPlanStyle; }

}  // namespace patina
