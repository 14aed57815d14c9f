#include "tools/report/swatches.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "engine/core/luminance.h"
#include "export/html.h"
#include "tools/report/verdict.h"

namespace patina {

namespace {

constexpr size_t kMostSwatches = 36;
constexpr uint32_t kSize_px = 112;
constexpr double kPi = std::numbers::pi, kWhite = 0.8;
constexpr double kNearest_m = 0.3;  // lamps count as if they were so far away at least

constexpr std::string_view kSwatchStyle = R"css(
.swatches { display: grid; grid-template-columns: repeat(auto-fill, minmax(8.5rem, 1fr)); gap: 1rem; margin-top: .8rem; }
.swatches figure { margin: 0; text-align: center; }
.swatches img { width: 6rem; height: 6rem; border-radius: 50%; margin: 0 auto; }
.swatches figcaption { overflow-wrap: anywhere; }
.swatches b { display: block; color: var(--text); font-weight: 600; }
.unobserved { color: var(--warn); }
)css";

/// Ward's lobe (paper, Eq. 3 and 4) times its albedo, and the diffuse part.
glm::dvec3 brdf(const SegmentReflectance& material, glm::dvec3 normal, glm::dvec3 to_light, glm::dvec3 to_viewer) {
    const glm::dvec3 kd(material.kd.value_or(glm::vec3(0.5f)));
    const double cos_i = glm::dot(normal, to_light), cos_o = glm::dot(normal, to_viewer);
    if (!gloss_is_observed(material) || std::min(cos_i, cos_o) <= 0) return kd / kPi;
    const glm::dvec3 half = to_light + to_viewer;
    const double along = glm::dot(normal, half), alpha2 = double{material.gloss->alpha} * double{material.gloss->alpha};
    const double tan2 = std::max(glm::dot(half, half) / (along * along) - 1, 0.0);
    const double lobe = std::exp(-tan2 / alpha2) / (4 * kPi * alpha2 * std::sqrt(cos_i * cos_o));
    return kd / kPi + glm::dvec3(material.gloss->ks) * lobe;
}

/// Light from far away.
struct Beam {
    glm::dvec3 to_light, irradiance;
};

std::vector<Beam> beams_of(const Lighting& lights) {
    std::vector<Beam> beams;
    for (const Light& light : lights.lights) {
        const double distance_m = std::max(glm::length(light.position_m), kNearest_m);
        if (glm::length(light.position_m) > 0)
            beams.push_back({glm::normalize(light.position_m),
                             intensity_towards(light, glm::dvec3(0)) / (distance_m * distance_m)});
    }
    if (beams.empty()) {
        const glm::dvec3 strength = lights.ambient == glm::dvec3(0) ? glm::dvec3(1) : 2.0 * lights.ambient;
        beams.push_back({glm::normalize(glm::dvec3(-1, 1, 1.5)), kPi * strength});
    }
    return beams;
}

double exposure_of(const std::vector<Beam>& beams, glm::dvec3 ambient) {
    double strongest = 0;
    for (const Beam& beam : beams) strongest = std::max(strongest, luminance(beam.irradiance) / kPi);
    const double white = strongest + luminance(ambient);
    return white > 0 ? kWhite / white : 1;
}

std::string caption_of(const SegmentSummary& segment) {
    const std::string name = segment.name.empty() ? fmt::format("object {}", segment.id) : segment.name;
    const SegmentReflectance& known = segment.reflectance;
    const std::string gloss =
        gloss_is_observed(known)
            ? fmt::format("ks {:.2f}, alpha {:.2f}", luminance(known.gloss->ks), known.gloss->alpha)
            : std::string("<span class='unobserved'>gloss not observed</span>");
    return fmt::format("<b>{}</b>{}", html_escaped(name), gloss);
}

}  // namespace

Drawing swatch(const SegmentReflectance& material, const Lighting& lights, uint32_t size_px) {
    const std::vector<Beam> beams = beams_of(lights);
    const double exposure = exposure_of(beams, lights.ambient), radius = size_px / 2.0;
    const glm::dvec3 kd(material.kd.value_or(glm::vec3(0.5f))), to_viewer(0, 0, 1);
    Drawing drawing({size_px, size_px});
    for (uint32_t y = 0; y < size_px; ++y) {
        for (uint32_t x = 0; x < size_px; ++x) {
            glm::dvec2 at((x + 0.5 - radius) / radius, (radius - y - 0.5) / radius);
            if (glm::length(at) > 0.999) at *= 0.999 / glm::length(at);
            const glm::dvec3 normal(at, std::sqrt(1 - glm::dot(at, at)));
            glm::dvec3 radiance = lights.ambient * kd;
            for (const Beam& beam : beams)
                radiance += brdf(material, normal, beam.to_light, to_viewer) * beam.irradiance *
                            std::max(glm::dot(normal, beam.to_light), 0.0);
            drawing.at(x, y) = color_pixel(glm::vec3(exposure * radiance));
        }
    }
    return drawing;
}

std::string swatch_grid(std::span<const SegmentSummary> segments, const Lighting& lights, glm::dvec3 center_m) {
    std::vector<const SegmentSummary*> largest;
    for (const SegmentSummary& segment : segments)
        if (segment.reflectance.kd) largest.push_back(&segment);
    std::ranges::stable_sort(largest, std::ranges::greater(),
                             [](const SegmentSummary* segment) { return segment->reflectance.voxels; });
    if (largest.size() > kMostSwatches) largest.resize(kMostSwatches);
    if (largest.empty()) return {};
    Lighting around = lights;
    for (Light& light : around.lights) light.position_m -= center_m;
    std::string html = "<div class='swatches'>\n";
    for (const SegmentSummary* segment : largest) {
        html += fmt::format("<figure><img alt='' src='data:image/png;base64,{}'><figcaption>{}</figcaption></figure>\n",
                            base64(png_of(swatch(segment->reflectance, around, kSize_px))), caption_of(*segment));
    }
    return html + "</div>\n";
}

std::string_view swatch_style() { return kSwatchStyle; }

}  // namespace patina
